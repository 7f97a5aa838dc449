#include "lights/direct_light/direct_light.h"

#include "core/geometry/shadow_segment.h"
#include "core/scene/media_along.h"

namespace mote::lights {

using namespace core;

namespace {

/// Multiplies by the transmittance of media, transmittance_of(medium, ray), and of panes along the ray.
/// Returns false where it is 0.
template <typename TransmittanceOf>
bool attenuate(const LitScene& scene, const Ray& ray, const MediumState& state, PathWeights& connection,
               const TransmittanceOf& transmittance_of) {
    const auto medium = [&](float t0, float t1, const MediumState& here) {
        const Medium* m = here.current();
        if (!m || !(t0 < t1)) return true;
        connection.throughput *= transmittance_of(*m, Ray{ray.origin, ray.direction, t0, t1});
        return !is_black(connection.throughput);
    };
    const auto pane = [&](const SurfaceHit& hit) {
        return connect_through(passage_through(hit, ray.direction), connection);
    };
    return for_each_part(scene, ray, state, medium, pane).has_value();
}

/// The transmittance along a connection without surfaces. Returns false where nothing comes through.
template <bool Media>
bool come_through(const LitScene& scene, const ScatteringVertex& vertex, const LightConnection& c,
                  const MediumState& state, PathWeights& weights, WalkContext& context,
                  const LightSampling& how) {
    Ray ray = c.shadow;
    if (c.light.delta) ray.t_max = c.light.distance;  // there is no surface at its end
    if constexpr (Media) {
        weights.light = weights.unidirectional;
        const MediumState start = vertex.state_towards(state, c.light.wi);
        if (how.marched_voxels > 0.0f && c.light.delta)
            return attenuate(scene, ray, start, weights, [&](const Medium& m, const Ray& r) {
                return Rgb(glm::exp(-m.optical_depth_along(r, how.marched_voxels, context.tracking)));
            });
        if (how.passes_media)
            return attenuate(scene, ray, start, weights, [&](const Medium& m, const Ray& r) {
                PathWeights passed;  // as unguided paths connect: few lookups, and no less noise is needed
                m.connect(r, passed, context.rng, context.tracking);
                return passed.throughput;
            });
        const Medium* there = scene.connect(ray, start, weights, context.rng, context.tracking);
        return !c.light.inside || there == c.light.inside;
    } else {
        weights.unidirectional = weights.light = Rgb(1.0f);
        connect_through_panes(scene, ray, weights);
        return !is_black(weights.throughput);
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

bool begin_connection(const ScatteringVertex& vertex, const LightChoice& choice, const Vec2& u,
                      const LightSampling& how, bool media, LightConnection& c) {
    if (!choice.emitter) return false;
    if (how.lit_along && !vertex.on_surface() && choice.emitter->traits().delta_position) return false;
    const auto light = choice.emitter->sample_direct(vertex.position, u);
    if (!light) return false;
    const ScatteringValue f = vertex.eval_cos_and_pdf(light->wi, TransportMode::radiance);
    if (is_black(f.f_cos)) return false;
    c.light = *light, c.f_cos = f.f_cos;
    c.pdf_light = choice.probability * (light->delta ? 1.0f : light->pdf_solid_angle);
    c.pdf_scatter = light->delta ? 0.0f : f.pdf_solid_angle * light->line_density;
    c.map =
        media && how.maps && !vertex.on_surface() && light->delta ? how.maps->of(*choice.emitter) : nullptr;
    c.shadow = {vertex.ray_origin(light->wi), light->wi};
    c.shadow.t_max = light->inside ? light->distance : shadow_end(c.shadow.origin, light->distance);
    return true;
}

template <bool Media>
Rgb finish_connection(const LitScene& scene, const ScatteringVertex& vertex, const PathWeights& weights,
                      const MediumState& state, const LightConnection& c, WalkContext& context,
                      const LightSampling& how) {
    PathWeights connection = weights;
    if (Media && c.map) {
        connection.light = weights.unidirectional;
        connection.throughput *= c.map->transmittance(vertex.position);
    } else if (!come_through<Media>(scene, vertex, c, state, connection, context, how)) {
        return Rgb(0.0f);
    }
    // f = throughput f* C* T L_e over the sum of both techniques' pdfs: the balance heuristic (Veach 1997,
    // Eq. 9.8), averaged over channels. A delta light is found by this one alone.
    const Rgb radiance = c.light.weight * (c.light.delta ? 1.0f : c.light.pdf_solid_angle);
    const Rgb pdfs = connection.light * c.pdf_light + connection.unidirectional * c.pdf_scatter;
    const float pdf = channel_average<Media>(pdfs);
    return pdf > 0.0f ? connection.throughput * c.f_cos * radiance / pdf : Rgb(0.0f);
}

template <bool Media>
Rgb connect_light(const LitScene& scene, const ScatteringVertex& vertex, const PathWeights& weights,
                  const MediumState& state, const LightChoice& choice, const Vec2& u, WalkContext& context,
                  const LightSampling& how) {
    LightConnection connection;
    if (!begin_connection(vertex, choice, u, how, Media, connection)) return Rgb(0.0f);
    if (!connection.map) {
        ++context.rays.occlusion;
        if (!scene.visible(connection.shadow)) return Rgb(0.0f);
    }
    return finish_connection<Media>(scene, vertex, weights, state, connection, context, how);
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
    // Eq. 9.8 seen from the other technique: weights.light holds n / p(w) of the direction that led
    // here, n the samples of lights where it left.
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
template Rgb finish_connection<true>(const LitScene&, const ScatteringVertex&, const PathWeights&,
                                     const MediumState&, const LightConnection&, WalkContext&,
                                     const LightSampling&);
template Rgb finish_connection<false>(const LitScene&, const ScatteringVertex&, const PathWeights&,
                                      const MediumState&, const LightConnection&, WalkContext&,
                                      const LightSampling&);
template Rgb found_light<true>(const LitScene&, const WalkEvent&, const Ray&, const PathWeights&,
                               const LightReceiver*);
template Rgb found_light<false>(const LitScene&, const WalkEvent&, const Ray&, const PathWeights&,
                                const LightReceiver*);

}  // namespace mote::lights
