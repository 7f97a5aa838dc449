// From shapes to Embree geometries: meshes share their buffers, analytic shapes answer by callback.
#pragma once

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/embree_api.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::core::embree {

Geometry make_geometry(RTCDevice device, const TriangleMesh& mesh);
Geometry make_geometry(RTCDevice device, const AnalyticShape& shape);

/// Filter that records every hit in Query::collected and lets the ray go on.
void collect_hits(const RTCFilterFunctionNArguments* arguments);

}  // namespace mote::core::embree
