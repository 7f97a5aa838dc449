// Direct light at a vertex by two techniques, combined by the balance heuristic (Veach 1997, Eq. 9.8):
// next-event estimation, and directions from the BSDF or phase function that happen to hit a light.
//
// With media, the weights follow the spectral book-keeping of PathWeights; without, they reduce to scalars.
#pragma once

#include "core/math/sampler.h"
#include "core/scene/lit_scene.h"
#include "core/scene/scattering_vertex.h"
#include "lights/shadow_maps/light_shadow_maps.h"

namespace mote::lights {

/// Average over channels of the rescaled pdfs; exactly 1 without media, where no channel differs.
template <bool Media>
inline float channel_average(const core::Rgb& pdfs) {
    if constexpr (Media) return core::average(pdfs);
    return pdfs.x;
}

/// The weight of light that reaches the end of a path with these weights.
template <bool Media>
inline core::Rgb throughput_of(const core::PathWeights& weights) {
    return weights.throughput / channel_average<Media>(weights.unidirectional);
}

/// Options of light sampling.
struct LightSampling {
    /// Point and spot lights do not count at a vertex in a medium: they were sampled along the ray that led
    /// there (equiangular sampling, marching).
    bool lit_along = false;
    /// At vertices in media, visibility and transmittance come from the map of the light where it has one.
    const LightShadowMaps* maps = nullptr;
    /// Above 0: what media take from lights that no direction hits is marched, in steps of so many voxels:
    /// without noise, biased by the step (Medium::optical_depth_along).
    float marched_voxels = 0.0f;
    /// Paths reach the end of a segment with certainty, weighted by its transmittance: the density of the
    /// other technique does not hold it.
    bool passes_media = false;
};

/// Next-event estimation: the light at `vertex` from one light sampled by `u_light` (and a point on it by
/// `u`), weighted against directions from vertex.sample(). `weights` and `state` describe the path up to the
/// vertex.
template <bool Media>
core::Rgb sample_light(const core::LitScene& scene, const core::ScatteringVertex& vertex,
                       const core::PathWeights& weights, const core::MediumState& state, float u_light,
                       const core::Vec2& u, core::WalkContext& context, const LightSampling& how = {});

/// A light sampled for a vertex, of which only the way to it is not known yet.
struct LightConnection {
    core::DirectSample light{};
    core::Ray shadow;          ///< the segment that has to be free of surfaces
    core::Rgb f_cos{0.0f};     ///< what the vertex scatters from there
    float pdf_light = 0.0f;    ///< of this sample
    float pdf_scatter = 0.0f;  ///< of the direction by the other technique; 0: that cannot find this light
    const VolumetricShadowMap* map = nullptr;  ///< holds visibility and transmittance: no ray is needed
};
/// Samples a light as sample_light() does. Returns false where no light arrives, whatever lies between.
bool begin_connection(const core::ScatteringVertex& vertex, const core::LightChoice& choice,
                      const core::Vec2& u, const LightSampling& how, bool media, LightConnection& connection);
/// The light that arrives by a connection whose shadow ray is free.
template <bool Media>
core::Rgb finish_connection(const core::LitScene& scene, const core::ScatteringVertex& vertex,
                            const core::PathWeights& weights, const core::MediumState& state,
                            const LightConnection& connection, core::WalkContext& context,
                            const LightSampling& how);

/// sample_light() for a given choice of the light, divided by its probability.
template <bool Media>
core::Rgb connect_light(const core::LitScene& scene, const core::ScatteringVertex& vertex,
                        const core::PathWeights& weights, const core::MediumState& state,
                        const core::LightChoice& choice, const core::Vec2& u, core::WalkContext& context,
                        const LightSampling& how = {});

/// Light emitted at the end of a walk: an area light at the surface, or the environment outside. `previous`
/// is the vertex whose sampled direction led here, null where next-event estimation could not have found this
/// light (the eye itself, or a delta scattering): then the full contribution counts.
template <bool Media>
core::Rgb found_light(const core::LitScene& scene, const core::WalkEvent& event, const core::Ray& ray,
                      const core::PathWeights& weights, const core::LightReceiver* previous);

/// Multiplies `weights` by a scattering sampled at `position` and prepares its rescaled pdfs for the next
/// event. `light_samples`: of next-event estimation there.
template <bool Media>
inline void apply_scattering(core::PathWeights& weights, const core::ScatterSample& s,
                             const core::Vec3& position, int light_samples = 1) {
    weights.throughput *= s.weight;
    weights.vertex = position;
    const core::Rgb base = Media ? weights.unidirectional : core::Rgb(1.0f);
    weights.light = s.delta || !(s.pdf_solid_angle > 0.0f) ? core::Rgb(0.0f)
                                                           : base * float(light_samples) / s.pdf_solid_angle;
}

/// The other technique for direct light: what lies in the direction `s` that `vertex` scatters to, and the
/// emission on the way. `weights` and `state` describe the path up to the vertex, as for sample_light().
template <bool Media>
core::Rgb light_towards(const core::LitScene& scene, const core::ScatteringVertex& vertex,
                        const core::ScatterSample& s, core::PathWeights weights, core::MediumState state,
                        core::WalkContext& context) {
    apply_scattering<Media>(weights, s, vertex.position);
    if (core::is_black(weights.throughput)) return core::Rgb(0.0f);
    if (Media && vertex.on_surface()) state = vertex.state_towards(state, s.wi);
    const core::Ray ray{vertex.ray_origin(s.wi), s.wi};
    core::Rgb emitted(0.0f);
    const core::WalkEvent event = core::walk<Media>(scene, ray, state, weights, emitted, context);
    const core::LightReceiver here = vertex.light_receiver();
    return emitted + found_light<Media>(scene, event, ray, weights, s.delta ? nullptr : &here);
}

}  // namespace mote::lights
