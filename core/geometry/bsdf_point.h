// Arguments of BSDFs and textures at a point of a surface.
#pragma once

#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"

namespace mote::core {

/// Texture coordinates of a hit or a sample, with its position.
template <typename Point>
TextureCoordinates texture_place(const Point& point) {
    TextureCoordinates place = point.uv;
    place.position = point.position;
    return place;
}

/// Texture coordinates and position; and where the shape says that they matter, the derivatives in the
/// shading frame.
inline BsdfPoint bsdf_point(const SurfaceHit& hit) {
    BsdfPoint p{texture_place(hit)};
    if (!hit.shape || !hit.shape->tangent_matters) return p;
    p.dp_du = hit.shading.to_local(hit.dp_du), p.dp_dv = hit.shading.to_local(hit.dp_dv);
    p.geometric_normal = hit.shading.to_local(hit.geometric_normal);
    return p;
}

}  // namespace mote::core
