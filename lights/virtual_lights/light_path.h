// One light path: from a light through surfaces and media, vertex by vertex.
//
// Engelhardt 2013, Sec. 10.1.1 (with the two slips of its step 1 put right, see docs/errata.md):
//   alpha_1     = L_e C*(y0->y1) tau / (p_A(y0) p_w(w0) p(t0))
//   alpha_{i+1} = alpha_i f* C* tau / (q p(w) p(t))
// Distances are sampled by delta tracking, so tau/p(t) is 1 at a surface and sigma_s/sigma_t goes to a volume
// vertex: alpha is the power that a particle brings to its vertex, times the albedo in a medium.
#pragma once

#include <algorithm>

#include "core/math/sampler.h"
#include "core/objects/memory_budget.h"
#include "core/scene/emission_ray.h"
#include "core/scene/light_from_infinity.h"
#include "core/scene/lit_scene.h"
#include "core/scene/russian_roulette.h"
#include "core/scene/scattering_vertex.h"

namespace mote::lights {

struct LightPathSettings {
    std::uint32_t paths = 1024;
    int max_vertices = -1;  ///< vertices on a light path after the light, delta ones included; -1: no limit
    int rr_depth = 5;       ///< Russian roulette after this many vertices
    bool keep_starts = false;        ///< of trace_light_paths(): VplSet::starts
    bool keep_states = true;         ///< of trace_light_paths(), in media: VplSet::states
    core::MemoryBudget memory = {};  ///< of all that the paths leave
};

/// Fraction of the path's first power that is left; never below 1/20, so that one dark bounce does not end
/// it.
inline float remaining_power(const core::Rgb& alpha, const core::Rgb& alpha_start) {
    const float start = core::max_component(alpha_start);
    return start > 0.0f ? std::max(core::max_component(alpha) / start, 0.05f) : 0.0f;
}

/// Ignores how a path begins.
struct AnyStart {
    void operator()(const core::LightChoice&, const core::EmissionSample&) const {}
};

/// Ignores the segments between vertices.
struct AnySegment {
    void operator()(const core::Ray&, const core::MediumState&, const core::PathWeights&,
                    const core::WalkEvent&, int) const {}
};

/// Follows a particle of `emitter` whose power over the number of paths is `start` [W]: calls visit(vertex,
/// alpha / paths, depth, state) at every vertex, delta surfaces included; `depth` counts from 1 at the first.
/// The vertex's `wo` points back along the path; `state` holds the media on its side. Before, on_segment(ray,
/// state, weights, event, depth) receives the segment to it, with media and weights at its start and
/// context.boundary_hits; also where the particle leaves the scene.
template <bool Media, typename Visit, typename OnSegment = AnySegment>
void follow_particle(const core::LitScene& scene, const LightPathSettings& settings,
                     const core::Emitter& emitter, const core::EmissionSample& emission,
                     const core::Rgb& start, core::Sampler& sampler, core::WalkContext& context,
                     const Visit& visit, const OnSegment& on_segment = {}) {
    core::PathWeights weights;
    weights.throughput = start;
    core::MediumState state;
    if constexpr (Media) {
        weights.hero = core::sample_hero(context.rng);
        state = scene.emitter_medium_state(emitter, emission);
        if (emission.inside && state.current() != emission.inside) return;
        if (!core::reaches_scene(emitter, state)) return;
    }
    core::Ray ray = core::emission_ray(emitter, emission);
    for (int depth = 1; settings.max_vertices < 0 || depth <= settings.max_vertices; ++depth) {
        core::Rgb emitted(0.0f);
        // tau / p(t): sigma_s / sigma_t at a collision, 1 at a surface.
        [[maybe_unused]] const core::MediumState state_before = state;
        [[maybe_unused]] const core::PathWeights weights_before = weights;
        const core::WalkEvent event = core::walk<Media>(scene, ray, state, weights, emitted, context);
        on_segment(ray, state_before, weights_before, event, depth);
        if (event.kind == core::WalkEvent::Kind::escaped) return;
        const core::ScatteringVertex vertex = make_vertex(event, ray);
        const float channels = Media ? core::average(weights.unidirectional) : 1.0f;
        visit(vertex, weights.throughput / channels, depth, state);

        if (depth > settings.rr_depth) {
            const float q = core::survival_chance(remaining_power(weights.throughput / channels, start),
                                                  depth, core::long_light_path);
            if (context.rng.next_float() >= q) return;
            weights.throughput /= q;  // 1 / q of alpha_{i+1}
        }
        const float u_lobe = sampler.next_1d();
        const auto next = vertex.sample(u_lobe, sampler.next_2d(), core::TransportMode::power);
        if (!next) return;
        // f* C* / p(w) of alpha_{i+1} (Engelhardt 2013, Sec. 10.1.1, step 2).
        weights.throughput *= next->weight * adjoint_correction(vertex, vertex.wo, next->wi);
        if (core::is_black(weights.throughput)) return;
        if (Media && vertex.on_surface()) state = vertex.state_towards(state, next->wi);
        ray = core::Ray{vertex.ray_origin(next->wi), next->wi};
    }
}

/// Follows a path of a light that is sampled by its power. `on_start(choice, emission)` is called first,
/// for a path that there is.
template <bool Media, typename Visit, typename Start = AnyStart, typename OnSegment = AnySegment>
void follow_light_path(const core::LitScene& scene, const LightPathSettings& settings, core::Sampler& sampler,
                       core::WalkContext& context, const Visit& visit, const Start& on_start = {},
                       const OnSegment& on_segment = {}) {
    float u_light = sampler.next_1d();
    const core::LightChoice choice = scene.choose_emitter_by_power(u_light, &u_light);
    const core::Vec2 u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    if (!choice.emitter) return;
    const auto emission = choice.emitter->sample_emission(u_position, u_direction);
    if (!emission) return;
    on_start(choice, *emission);
    // alpha_1, with the cosine at the light, over the paths (Engelhardt 2013, Sec. 10.1.1, step 3).
    const core::Rgb start = emission->weight / (choice.probability * float(settings.paths));
    follow_particle<Media>(scene, settings, *choice.emitter, *emission, start, sampler, context, visit,
                           on_segment);
}

}  // namespace mote::lights
