// Receivers of micro-buffers that stand on surfaces.
#pragma once

#include "core/math/sampler.h"
#include "core/scene/scattering_vertex.h"
#include "gathering/micro_buffers/micro_buffers.h"

namespace mote::gathering {

/// On the side of vertex.wo, just off the surface, about the shading normal; `turn` in [0, 1) turns the
/// texels.
inline MicroReceiver micro_receiver(const core::ScatteringVertex& vertex, float turn) {
    const bool front = glm::dot(vertex.hit.geometric_normal, vertex.wo) > 0.0f;
    const core::Vec3 outside = front ? vertex.hit.geometric_normal : -vertex.hit.geometric_normal;
    const core::Frame frame(front ? vertex.hit.shading.n : -vertex.hit.shading.n);
    const float angle = 2.0f * core::pi * turn, c = std::cos(angle), s = std::sin(angle);
    return {core::offset_origin(vertex.hit, outside),
            core::Frame(c * frame.s + s * frame.t, c * frame.t - s * frame.s, frame.n)};
}

}  // namespace mote::gathering
