#include "lights/direct_light/direct_light.h"

#include "core/scene/media_along.h"
#include "core/scene/shadow_segment.h"

namespace mote::lights {

using namespace core;

namespace {

/// Multiplies by the transmittance of media and panes along the ray, by marching. Returns false where it is
/// 0.
bool march_to_light(const LitScene& scene, const Ray& ray, const MediumState& state, float voxels,
                    PathWeights& connection, WalkContext& context) {
    const auto medium = [&](float t0, float t1, const MediumState& here) {
        const Medium* m = here.current();
        if (!m || !(t0 < t1)) return true;
        const Vec3d depth =
            m->optical_depth_along({ray.origin, ray.direction, t0, t1}, voxels, context.tracking);
        connection.throughput *= Rgb(glm::exp(-depth));
        return !is_black(connection.throughput);
    };
    const auto pane = [&](const SurfaceHit& hit) {
        return connect_through(passage_through(hit, ray.direction), connection);
    };
    return for_each_part(scene, ray, state, medium, pane).has_value();
}

/// By a shadow ray and the transmittance along it. Returns whether the light is seen.
template <bool Media>
bool reaches_light(const LitScene& scene, const ScatteringVertex& vertex, const DirectSample& light,
                   const MediumState& state, PathWeights& connection, WalkContext& context,
                   const LightSampling& how) {
    Ray shadow{vertex.ray_origin(light.wi), light.wi};
    shadow.t_max = light.distance * (light.inside ? 1.0f : shadow_fraction);
    ++context.rays.occlusion;
    if (!scene.visible(shadow)) return false;
    if (light.delta) shadow.t_max = light.distance;  // there is no surface at its end
    if constexpr (Media) {
        connection.light = connection.unidirectional;
        if (how.marched_voxels > 0.0f && light.delta)
            return march_to_light(scene, shadow, vertex.state_towards(state, light.wi), how.marched_voxels,
                                  connection, context);
        const Medium* there = scene.connect(shadow, vertex.state_towards(state, light.wi), connection,
                                            context.rng, context.tracking);
        return !light.inside || there == light.inside;
    } else {
        connection.unidirectional = connection.light = Rgb(1.0f);
        connect_through_panes(scene, shadow, connection);
        return !is_black(connection.throughput);
    }
}
}  // namespace

template <bool Media>
Rgb sample_light(const LitScene& scene, const ScatteringVertex& vertex, const PathWeights& weights,
                 const MediumState& state, float u_light, const Vec2& u, WalkContext& context,
                 const LightSampling& how) {
    return connect_light<Media>(scene, vertex, weights, state,
                                scene.choose_light(vertex.light_receiver(), u_light), u, context, how);
}

template <bool Media>
Rgb connect_light(const LitScene& scene, const ScatteringVertex& vertex, const PathWeights& weights,
                  const MediumState& state, const LightChoice& choice, const Vec2& u, WalkContext& context,
                  const LightSampling& how) {
    if (!choice.emitter) return Rgb(0.0f);
    if (how.lit_along && !vertex.on_surface() && choice.emitter->traits().delta_position) return Rgb(0.0f);
    const auto light = choice.emitter->sample_direct(vertex.position, u);
    if (!light) return Rgb(0.0f);
    const Rgb f_cos = vertex.eval_cos(light->wi, TransportMode::radiance);
    if (is_black(f_cos)) return Rgb(0.0f);

    PathWeights connection = weights;
    const VolumetricShadowMap* map =
        Media && how.maps && !vertex.on_surface() && light->delta ? how.maps->of(*choice.emitter) : nullptr;
    if (map) {
        connection.light = weights.unidirectional;
        connection.throughput *= map->transmittance(vertex.position);
    } else if (!reaches_light<Media>(scene, vertex, *light, state, connection, context, how)) {
        return Rgb(0.0f);
    }
    // f = throughput f* C* T L_e over the sum of both techniques' pdfs: the balance heuristic (Veach 1997,
    // Eq. 9.8), averaged over channels. A delta light is found by this one alone.
    const float pdf_light = choice.probability * (light->delta ? 1.0f : light->pdf_solid_angle);
    const float pdf_scatter =
        light->delta ? 0.0f
                     : vertex.pdf_solid_angle(light->wi, TransportMode::radiance) * light->line_density;
    const Rgb radiance = light->weight * (light->delta ? 1.0f : light->pdf_solid_angle);
    const Rgb pdfs = connection.light * pdf_light + connection.unidirectional * pdf_scatter;
    const float pdf = channel_average<Media>(pdfs);
    return pdf > 0.0f ? connection.throughput * f_cos * radiance / pdf : Rgb(0.0f);
}

template <bool Media>
Rgb found_light(const LitScene& scene, const WalkEvent& event, const Ray& ray, const PathWeights& weights,
                const LightReceiver* previous) {
    const Emitter* emitter = nullptr;
    const SurfaceHit* hit = nullptr;
    Rgb radiance(0.0f);
    if (event.kind == WalkEvent::Kind::surface) {
        emitter = event.hit.shape->emitter.get(), hit = &event.hit;
        if (emitter) radiance = emitter->radiance(event.hit, -ray.direction);
    } else if (event.kind == WalkEvent::Kind::escaped) {
        emitter = scene.environment();
        if (emitter) radiance = emitter->environment(ray.direction);
    }
    if (!emitter || is_black(radiance)) return Rgb(0.0f);
    const Rgb unidirectional = Media ? weights.unidirectional : Rgb(1.0f);
    if (!previous) return weights.throughput * radiance / channel_average<Media>(unidirectional);
    const float pdf_light = scene.light_probability(*previous, emitter) *
                            emitter->pdf_direct(previous->position, ray.direction, hit);
    // Eq. 9.8 seen from the other technique: weights.light holds 1 / p(w) of the direction that led here.
    return weights.throughput * radiance / channel_average<Media>(unidirectional + weights.light * pdf_light);
}

template Rgb sample_light<true>(const LitScene&, const ScatteringVertex&, const PathWeights&,
                                const MediumState&, float, const Vec2&, WalkContext&, const LightSampling&);
template Rgb sample_light<false>(const LitScene&, const ScatteringVertex&, const PathWeights&,
                                 const MediumState&, float, const Vec2&, WalkContext&, const LightSampling&);
template Rgb connect_light<true>(const LitScene&, const ScatteringVertex&, const PathWeights&,
                                 const MediumState&, const LightChoice&, const Vec2&, WalkContext&,
                                 const LightSampling&);
template Rgb connect_light<false>(const LitScene&, const ScatteringVertex&, const PathWeights&,
                                  const MediumState&, const LightChoice&, const Vec2&, WalkContext&,
                                  const LightSampling&);
template Rgb found_light<true>(const LitScene&, const WalkEvent&, const Ray&, const PathWeights&,
                               const LightReceiver*);
template Rgb found_light<false>(const LitScene&, const WalkEvent&, const Ray&, const PathWeights&,
                                const LightReceiver*);

}  // namespace mote::lights
