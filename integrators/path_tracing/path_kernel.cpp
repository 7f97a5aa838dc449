#include "integrators/path_tracing/path_kernel.h"

#include <algorithm>

#include "compensation/bounded_geometry.h"
#include "core/scene/scene.h"
#include "integrators/eye_path/eye_roulette.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Sorts light into layers, and holds the weight of the bounded edge.
class PathClassifier {
  public:
    /// Layer of a light connected to the vertex at the end of the current edge.
    Transport layer_of_connection(bool on_surface) const {
        if (scatterings_ == 0) return on_surface ? Transport::direct : Transport::single_scattering;
        return surface_first_ ? Transport::indirect : Transport::multiple_scattering;
    }
    /// Layer of light found at the end of the current edge.
    Transport layer_of_emission() const {
        if (scatterings_ == 0) return Transport::emission;
        if (scatterings_ == 1) return surface_first_ ? Transport::direct : Transport::single_scattering;
        return surface_first_ ? Transport::indirect : Transport::multiple_scattering;
    }
    int scatterings() const { return scatterings_; }

    void scatter(const ScatteringVertex& v, const ScatterSample& s) {
        if (s.delta && scatterings_ == 0) return;  // mirrors and glass before the first connectable vertex
        if (scatterings_ == 0) surface_first_ = v.on_surface(), start_cosine_ = v.shading_cosine(s.wi);
        ++scatterings_;
    }
    /// min(G*, b)/G* of the edge that starts at the first connectable vertex and ends at `v`.
    float bound_weight(const ScatteringVertex& v, float distance, float bound) const {
        return compensation::bounded_share(start_cosine_ * v.geometric_cosine(v.wo), distance, bound);
    }

  private:
    int scatterings_ = 0;
    bool surface_first_ = true;
    float start_cosine_ = 1.0f;
};

}  // namespace

template <bool Media>
TransportSum trace_path(const Scene& scene, const PathSettings& settings, Ray ray, MediumState state,
                        Sampler& sampler, WalkContext& context) {
    TransportSum sum;
    PathWeights weights;
    if constexpr (Media) weights.hero = std::min(int(context.rng.next_float() * 3.0f), 2);
    PathClassifier classifier;
    const bool bounded = std::isfinite(settings.bound);
    const bool lit_along = Media && settings.equiangular && !settings.equiangular->empty();
    Vec3 previous_position;
    bool connected = false;  // could next-event estimation have found what the current edge leads to?
    float eta = 1.0f;

    for (int depth = 1; settings.max_depth < 0 || depth <= settings.max_depth; ++depth) {
        Rgb emitted(0.0f);
        const MediumState start = state;
        const Rgb throughput = weights.throughput / lights::channel_average<Media>(weights.unidirectional);
        const WalkEvent event = walk<Media>(scene, ray, state, weights, emitted, context);
        const Transport found = classifier.layer_of_emission();
        if constexpr (Media) sum[found] += emitted;
        sum[found] +=
            lights::found_light<Media>(scene, event, ray, weights, connected ? &previous_position : nullptr);
        if (depth == settings.max_depth) break;
        if (lit_along)
            sum[classifier.layer_of_connection(false)] +=
                throughput * settings.equiangular->scattered_along(scene, ray, event.surface_distance, start,
                                                                   sampler.next_2d(), context);
        if (event.kind == WalkEvent::Kind::escaped) break;

        const ScatteringVertex vertex = make_vertex(event, ray);
        const bool vpl_edge = bounded && classifier.scatterings() == 1;
        if (vpl_edge) weights.throughput *= classifier.bound_weight(vertex, event.distance, settings.bound);

        const Vec2 choices = sampler.next_2d();  // of the light, and of the lobe
        if (vertex.connectable()) {
            const Vec2 u_light = sampler.next_2d();
            sum[classifier.layer_of_connection(vertex.on_surface())] += lights::sample_light<Media>(
                scene, vertex, weights, state, choices.x, u_light, context, lit_along);
        }
        if (depth >= settings.rr_depth && !survives<Media>(weights, eta, depth, context.rng.next_float()))
            break;

        const auto next = vertex.sample(choices.y, sampler.next_2d(), TransportMode::radiance);
        if (!next) break;
        // No VPL stands on a delta surface: what goes on from there is not part of the bounded transport.
        if (vpl_edge && next->delta) break;
        classifier.scatter(vertex, *next);
        lights::apply_scattering<Media>(weights, *next, vertex.position);
        if (is_black(weights.throughput)) break;
        if (Media && vertex.on_surface()) state = vertex.state_towards(state, next->wi);
        eta *= next->eta;
        connected = !next->delta, previous_position = vertex.position;
        ray = Ray{vertex.ray_origin(next->wi), next->wi};
    }
    return sum;
}

template TransportSum trace_path<true>(const Scene&, const PathSettings&, Ray, MediumState, Sampler&,
                                       WalkContext&);
template TransportSum trace_path<false>(const Scene&, const PathSettings&, Ray, MediumState, Sampler&,
                                        WalkContext&);

}  // namespace mote::integrators
