// Light of the light sources that a vertex scatters, by both techniques of next-event estimation.
#pragma once

#include "core/math/sampler.h"
#include "lights/direct_light/direct_light.h"

namespace mote::integrators {

/// Estimate of the light that scatters at `vertex` once, times `weights`: one light sampled for the vertex,
/// and one direction that it scatters to, combined by multiple importance sampling. Light through delta parts
/// is left out. `state` holds the media at the vertex; `how` applies to the connection.
template <bool Media>
core::Rgb scattered_light(const core::LitScene& scene, const core::ScatteringVertex& vertex,
                          const core::PathWeights& weights, const core::MediumState& state,
                          core::Sampler& sampler, core::WalkContext& context,
                          const lights::LightSampling& how = {}) {
    const core::Vec2 choices = sampler.next_2d();  // light, lobe
    core::Rgb sum = lights::sample_light<Media>(scene, vertex, weights, state, choices.x, sampler.next_2d(),
                                                context, how);
    const auto next = vertex.sample(choices.y, sampler.next_2d(), core::TransportMode::radiance);
    if (next && !next->delta)
        sum += lights::light_towards<Media>(scene, vertex, *next, weights, state, context);
    return sum;
}

}  // namespace mote::integrators
