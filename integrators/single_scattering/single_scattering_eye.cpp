#include "integrators/single_scattering/single_scattering_eye.h"

#include "core/scene/scene.h"
#include "lights/emitters/direct_light.h"

namespace mote::integrators {

using namespace core;
using namespace screenspace;
using lights::apply_scattering;
using lights::channel_average;
using lights::found_light;
using lights::light_along;
using lights::sample_light;

namespace {

/// The light found in the direction that `vertex` scatters to, weighted against sample_light() there.
template <bool Media>
Rgb scattered_to_light(const Scene& scene, const ScatteringVertex& vertex, const ScatterSample& s,
                       PathWeights weights, const MediumState& state, WalkContext& context) {
    apply_scattering<Media>(weights, s, vertex.position);
    if (is_black(weights.throughput)) return Rgb(0.0f);
    const MediumState there = Media && vertex.on_surface() ? vertex.state_towards(state, s.wi) : state;
    const Ray ray{vertex.ray_origin(s.wi), s.wi};
    return light_along<Media>(scene, ray, there, weights, &vertex.position, context);
}

/// Lights without a position, scattered once along the ray, and emission of media: by one sampled distance.
void add_other_lights(const Scene& scene, const EyeSettings& settings, const Ray& ray, MediumState state,
                      PathWeights weights, Sampler& sampler, WalkContext& context, TransportSum& sum) {
    weights.hero = std::min(int(context.rng.next_float() * 3.0f), 2);
    const WalkEvent event = walk<true>(scene, ray, state, weights, sum[Transport::emission], context);
    const Vec2 choices = sampler.next_2d(), u_light = sampler.next_2d(), u = sampler.next_2d();
    if (event.kind != WalkEvent::Kind::collision) return;
    const ScatteringVertex vertex = make_vertex(event, ray);
    Rgb& scattered = sum[Transport::single_scattering];
    scattered +=
        sample_light<true>(scene, vertex, weights, state, choices.x, u_light, context, true, settings.maps);
    if (const auto s = vertex.sample(choices.y, u, TransportMode::radiance))
        scattered += scattered_to_light<true>(scene, vertex, *s, weights, state, context);
}

/// From the ray's start to `hit` or into the distance: what media do to it. Returns the media at its end.
MediumState cross_media(const Scene& scene, const EyeSettings& settings,
                        std::span<const InScattering> positional, Ray ray, const MediumState& state,
                        bool first, Sampler& sampler, PathWeights& weights, MarchScratch& scratch,
                        TransportSum& sum) {
    if (settings.other_lights)
        add_other_lights(scene, settings, ray, state, weights, sampler, scratch.walk, sum);
    if (!first)
        for (const InScattering& light : positional)
            sum[Transport::single_scattering] +=
                weights.throughput * light.march(ray, state, scratch).radiance;
    find_segments(scene, ray, state, scratch.eye, scratch.walk);
    weights.throughput *= marched_transmittance(ray, scratch.eye, settings.voxels, scratch.walk);
    return scratch.eye.empty() ? state : scratch.eye.back().state;
}

}  // namespace

template <bool Media>
EyePath trace_eye(const Scene& scene, const EyeSettings& settings, std::span<const InScattering> positional,
                  Ray ray, MediumState state, Sampler& sampler, MarchScratch& scratch) {
    EyePath path;
    TransportSum& sum = path.sum;
    PathWeights weights;
    if constexpr (Media) weights.hero = std::min(int(scratch.walk.rng.next_float() * 3.0f), 2);
    for (int depth = 1; depth <= settings.max_depth; ++depth) {
        MediumState unused;
        Rgb nothing(0.0f);
        const WalkEvent event = walk<false>(scene, ray, unused, weights, nothing, scratch.walk);
        const bool hit = event.kind == WalkEvent::Kind::surface;
        if (hit && depth == 1) path.first = event.hit;
        if constexpr (Media) {
            Ray segment = ray;
            segment.t_max = event.surface_distance;
            state = cross_media(scene, settings, positional, segment, state, depth == 1, sampler, weights,
                                scratch, sum);
        }
        sum[Transport::emission] += found_light<Media>(scene, event, ray, weights, nullptr);
        if (!hit || is_black(weights.throughput)) break;

        const ScatteringVertex vertex = make_vertex(event, ray);
        const Vec2 choices = sampler.next_2d(), u_light = sampler.next_2d();
        if (vertex.connectable())
            sum[Transport::direct] +=
                sample_light<Media>(scene, vertex, weights, state, choices.x, u_light, scratch.walk);
        const auto next = vertex.sample(choices.y, sampler.next_2d(), TransportMode::radiance);
        if (!next) break;
        if (!next->delta) {
            sum[Transport::direct] +=
                scattered_to_light<Media>(scene, vertex, *next, weights, state, scratch.walk);
            break;
        }
        apply_scattering<Media>(weights, *next, vertex.position);
        if (is_black(weights.throughput)) break;
        if constexpr (Media) state = vertex.state_towards(state, next->wi);
        ray = Ray{vertex.ray_origin(next->wi), next->wi};
    }
    return path;
}

template EyePath trace_eye<true>(const Scene&, const EyeSettings&, std::span<const InScattering>, Ray,
                                 MediumState, Sampler&, MarchScratch&);
template EyePath trace_eye<false>(const Scene&, const EyeSettings&, std::span<const InScattering>, Ray,
                                  MediumState, Sampler&, MarchScratch&);

}  // namespace mote::integrators
