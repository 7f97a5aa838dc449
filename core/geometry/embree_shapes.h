// From shapes to Embree geometries and back: meshes share their buffers, analytic shapes answer by callback.
#pragma once

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/curves.h"
#include "core/geometry/embree_api.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::core::embree {

/// A shape that Embree traces by itself (no InstancedShape). It must outlive this.
class TracedShape {
  public:
    explicit TracedShape(const Shape& shape);

    const Shape& shape() const { return *shape_; }
    Geometry make_geometry(RTCDevice device) const;
    /// Fills a hit except t. The direction need not have unit length.
    void fill_hit(const Vec3& origin, const Vec3& direction, const RawHit& raw, SurfaceHit& hit) const;
    /// Two hits of one primitive on a ray are the same hit; a quadric has two that differ.
    bool once_per_primitive() const { return mesh_ != nullptr; }

  private:
    const Shape* shape_;
    const TriangleMesh* mesh_;       // or null
    const AnalyticShape* analytic_;  // or null
    const Curves* curves_;           // or null
};

/// Filter that records every hit in Query::collected and lets the ray continue.
void collect_hits(const RTCFilterFunctionNArguments* arguments);

}  // namespace mote::core::embree
