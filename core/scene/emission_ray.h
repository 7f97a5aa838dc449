// The ray of a light particle.
#pragma once

#include "core/geometry/shadow_segment.h"
#include "core/math/ray.h"
#include "core/scene/emitter.h"

namespace mote::core {

/// Ray along which the particle leaves the light. A light without a surface that lies on one does not light
/// it at the distance 0: shadow rays end before that surface, and particles begin behind it.
inline Ray emission_ray(const Emitter& emitter, const EmissionSample& sample) {
    const float begin = emitter.traits().delta_position ? rounding_distance(sample.origin) : 0.0f;
    return {sample.origin, sample.direction, begin};
}

}  // namespace mote::core
