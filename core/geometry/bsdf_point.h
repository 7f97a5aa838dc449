// What a BSDF asks about the place that a ray found.
#pragma once

#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"

namespace mote::core {

/// Texture coordinates; and where the shape says that they matter, the derivatives in the shading frame.
inline BsdfPoint bsdf_point(const SurfaceHit& hit) {
    BsdfPoint p{hit.uv};
    if (!hit.shape || !hit.shape->tangent_matters) return p;
    p.dp_du = hit.shading.to_local(hit.dp_du), p.dp_dv = hit.shading.to_local(hit.dp_dv);
    p.geometric_normal = hit.shading.to_local(hit.geometric_normal);
    return p;
}

}  // namespace mote::core
