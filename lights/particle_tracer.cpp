#include "lights/particle_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/scene/russian_roulette.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr std::uint32_t chunk_size = 32;
constexpr std::uint32_t light_path_stream =
    0x56504cu;  // keeps light paths apart from pixels of the same index

/// Share of the path's first power that is left; never below 1/20, so that one dark bounce does not end it.
float remaining_power(const Rgb& alpha, const Rgb& alpha_start) {
    const float start = max_component(alpha_start);
    return start > 0.0f ? std::max(max_component(alpha) / start, 0.05f) : 0.0f;
}

template <bool Media>
void trace_path(const Scene& scene, const LightPathSettings& settings, std::uint32_t path, Sampler& sampler,
                WalkContext& context, VplSet& set) {
    float u_light = sampler.next_1d();
    const LightChoice choice = scene.choose_emitter_by_power(u_light, &u_light);
    const Vec2 u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    if (!choice.emitter) return;
    const auto emission = choice.emitter->sample_emission(u_position, u_direction);
    if (!emission) return;

    // Engelhardt 2013, Sec. 10.1.1: alpha_1, with the cosine at the light, over the paths (step 3 there).
    PathWeights weights;
    weights.throughput = emission->weight / (choice.probability * float(settings.paths));
    const Rgb start = weights.throughput;
    MediumState state;
    if constexpr (Media) {
        weights.hero = std::min(int(context.rng.next_float() * 3.0f), 2);
        state = scene.emitter_medium_state(*choice.emitter, *emission);
    }
    Ray ray{emission->origin, emission->direction};
    for (int depth = 1; settings.max_vertices < 0 || depth <= settings.max_vertices; ++depth) {
        Rgb emitted(0.0f);
        const WalkEvent event = walk<Media>(scene, ray, state, weights, emitted, context);
        if (event.kind == WalkEvent::Kind::escaped) return;
        const ScatteringVertex vertex = make_vertex(event, ray);
        const float channels = Media ? average(weights.unidirectional) : 1.0f;
        append_vpl(set, vertex, weights.throughput / channels, std::uint32_t(depth), path);

        if (depth > settings.rr_depth) {
            const float q = survival_chance(remaining_power(weights.throughput / channels, start), depth,
                                            long_light_path);
            if (context.rng.next_float() >= q) return;
            weights.throughput /= q;
        }
        const float u_lobe = sampler.next_1d();
        const auto next = vertex.sample(u_lobe, sampler.next_2d(), TransportMode::power);
        if (!next) return;
        weights.throughput *= next->weight * adjoint_correction(vertex, vertex.wo, next->wi);
        if (is_black(weights.throughput)) return;
        if (Media && vertex.on_surface()) state = vertex.state_towards(state, next->wi);
        ray = Ray{vertex.ray_origin(next->wi), next->wi};
    }
}

VplSet trace_chunk(const Scene& scene, const LightPathSettings& settings, std::uint32_t begin,
                   std::uint32_t end, std::uint64_t seed, std::uint32_t pass, SamplerKind kind) {
    VplSet set;
    for (std::uint32_t path = begin; path < end; ++path) {
        // The paths of one pass form one low-discrepancy set; every pass has a scramble of its own.
        Sampler sampler(kind, seed, path, pass, light_path_stream);
        WalkContext context;
        context.rng = Rng(hash_keys(seed, pass, path, light_path_stream));
        if (scene.has_media())
            trace_path<true>(scene, settings, path, sampler, context, set);
        else
            trace_path<false>(scene, settings, path, sampler, context, set);
        set.rays.add(context.rays);
        set.tracking.add(context.tracking);
    }
    return set;
}

void append(VplSet& to, VplSet&& from) {
    const auto offset = std::uint32_t(to.details.size());
    for (VirtualPointLight& vpl : from.lights)
        if (vpl.detail != VirtualPointLight::no_detail) vpl.detail += offset;
    to.lights.insert(to.lights.end(), from.lights.begin(), from.lights.end());
    to.details.insert(to.details.end(), from.details.begin(), from.details.end());
    to.rays.add(from.rays);
    to.tracking.add(from.tracking);
}

}  // namespace

VplSet trace_light_paths(const Scene& scene, const LightPathSettings& settings, std::uint64_t seed,
                         std::uint32_t pass, SamplerKind sampler) {
    const std::uint32_t chunks = (settings.paths + chunk_size - 1) / chunk_size;
    std::vector<VplSet> parts(chunks);
    tbb::parallel_for(std::uint32_t(0), chunks, [&](std::uint32_t c) {
        const std::uint32_t begin = c * chunk_size, end = std::min(begin + chunk_size, settings.paths);
        parts[c] = trace_chunk(scene, settings, begin, end, seed, pass, sampler);
    });
    VplSet set;
    for (VplSet& part : parts) append(set, std::move(part));
    set.paths = settings.paths;
    return set;
}

}  // namespace mote::lights
