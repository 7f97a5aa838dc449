// The density with which a path through a vertex would have been sampled from its other end: what multiple
// importance sampling needs to weight a technique against those that build the same path the other way.
#pragma once

#include "core/scene/scattering_vertex.h"

namespace mote::core {

/// A path that came to the vertex from `vertex.wo` in `mode` continues in direction wi. This is the density,
/// per solid angle, with which a path of the other mode that comes from wi is scattered to vertex.wo. Zero
/// for delta parts, as vertex.pdf_solid_angle() is.
inline float reverse_pdf_solid_angle(const ScatteringVertex& vertex, const Vec3& wi, TransportMode mode) {
    if (vertex.phase) return vertex.phase->pdf_solid_angle(wi, vertex.wo);
    const Frame& frame = vertex.hit.shading;
    return vertex.bsdf->pdf_solid_angle(vertex.bsdf_point(), frame.to_local(wi), frame.to_local(vertex.wo),
                                        opposite(mode)) /
           vertex.stop_chance;
}

}  // namespace mote::core
