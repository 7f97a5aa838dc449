#include "integrators/bidirectional/strategies.h"

#include "core/geometry/shadow_segment.h"
#include "core/scene/emission_ray.h"
#include "core/scene/light_from_infinity.h"

namespace mote::integrators {

using namespace core;

double light_connection(const LightEnds& ends, const PathVertex& first, const LightPoint& start,
                        const Subpath& path) {
    const PathVertex& light = path.vertices[0];
    if (!first.scattering.connectable() || !(light.density > 0.0)) return 0.0;
    const double sampled = ends.sampled(first.scattering.light_receiver(), start, first.distance_squared);
    return mis_term(path.heuristic, sampled / light.density) * path.connection_term();
}

template <bool Media>
bool Strategies<Media>::start_light_path(Sampler& sampler, SubpathWalk<Media>& walk) {
    float u_light = sampler.next_1d();
    const LightChoice choice = ends_.choose(u_light, &u_light);
    const Vec2 u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    if (!choice.emitter) return false;
    const auto emission = choice.emitter->sample_emission(u_position, u_direction);
    if (!emission) return false;
    light_start_ = {choice.emitter, emission->origin, emission->normal, -emission->direction};
    const LightEnds::Start start = ends_.start(light_start_);
    light_.without = choice.emitter->traits().can_be_hit() ? 1.0 : 0.0;
    PathVertex vertex;
    vertex.scattering.position = emission->origin, vertex.light_normal = emission->normal;
    vertex.start = true, vertex.infinite = light_start_.infinite(), vertex.density = start.light;
    light_.vertices.push_back(vertex);
    PathWeights weights;
    weights.throughput = emission->weight / choice.probability;
    MediumState state;
    if constexpr (Media) {
        weights.hero = sample_hero(context_.rng);
        state = scene_.emitter_medium_state(*choice.emitter, *emission);
        if (!reaches_scene(*choice.emitter, state)) return false;
    }
    walk.start(emission_ray(*choice.emitter, *emission), start.receiver, light_start_.infinite(), weights,
               state);
    return true;
}

/// The density with which the first vertex would sample the light.
template <bool Media>
void Strategies<Media>::finish_light_start() {
    PathVertex& first = light_.vertices[1];
    first.connection = light_connection(ends_, first, light_start_, light_);
}

template <bool Media>
float Strategies<Media>::worth_a_ray(double weight) {
    const float chance = chance_of_ray(float(weight));
    if (settings_.all_connections || !(chance < 1.0f)) return 1.0f;
    return context_.rng.next_float() < chance ? chance : 0.0f;
}

template <bool Media>
double Strategies<Media>::edge_along(const Ray& ray, const ScatteringVertex& from, const MediumState& state) {
    if constexpr (!Media) return 1.0;
    return edge_transmittance(scene_, ray, from.state_towards(state, ray.direction), context_.tracking);
}

template <bool Media>
Rgb Strategies<Media>::between(const Ray& segment, const ScatteringVertex& from, const MediumState& state,
                               float visible_to) {
    Ray shadow = segment;
    shadow.t_max = visible_to;
    ++context_.rays.occlusion;
    if (!scene_.visible(shadow)) return Rgb(0.0f);
    if (!scene_.attenuates()) return Rgb(1.0f);
    const MediumState start = Media ? from.state_towards(state, segment.direction) : state;
    if (std::isfinite(segment.t_max))
        return scene_.transmittance(segment.at(segment.t_min), segment.at(segment.t_max), start, context_.rng,
                                    context_.tracking);
    // To infinity. A channel of its own drives it: estimates that are multiplied must be independent.
    PathWeights weights;
    weights.light = Rgb(1.0f), weights.hero = sample_hero(context_.rng);
    scene_.connect(segment, start, weights, context_.rng, context_.tracking);
    return weights.throughput / average(weights.light);
}

template <bool Media>
std::optional<std::pair<Contribution, Vec2>> Strategies<Media>::join_to_lens(std::size_t s,
                                                                             const Vec2& u_lens) {
    const PathVertex& y = light_.vertices[s - 1];
    const ScatteringVertex& v = y.scattering;
    const Transport layer = transport_layer(int(s) - 1, v.on_surface());
    if (!v.connectable() || !settings_.limits.wanted[layer]) return std::nullopt;
    const Camera& camera = scene_.camera();
    const auto lens = camera.sample_importance(v.position, u_lens, filter_radius_);
    if (!lens) return std::nullopt;
    const Rgb f = v.eval_cos(lens->wi, TransportMode::power) * adjoint_correction(v, v.wo, lens->wi);
    if (is_black(f)) return std::nullopt;
    lens_point_ = lens->origin;
    const auto importance = camera.importance(lens->origin, -lens->wi, filter_radius_);
    if (!importance) return std::nullopt;
    const bool parallel = camera.traits().delta_direction;
    const double by_camera = double(parallel ? importance->pdf_area : importance->pdf_solid_angle) *
                             double(v.geometric_cosine(lens->wi)) /
                             (parallel ? 1.0 : double(lens->distance) * double(lens->distance));
    const double before = reverse_of_previous(light_, s - 1, lens->wi, TransportMode::power);
    // In terms of one light path: this technique has all of them.
    const double own = own_term(light_paths_);
    const auto weight_with = [&](double edge) {
        return connection_weight(own, light_.others(s - 1, by_camera * edge, before, edge, lens->wi), 0.0);
    };
    const float chance = worth_a_ray(weight_with(guessed_edge(y.sigma_here, double(lens->distance))));
    if (!(chance > 0.0f)) return std::nullopt;
    // Surfaces before the near plane hide nothing.
    Ray ray{v.ray_origin(lens->wi), lens->wi, 0.0f, lens->distance - lens->t_min};
    const Rgb seen = between(ray, v, y.state, ray.t_max);
    if (is_black(seen)) return std::nullopt;
    const auto w = float(weight_with(edge_along(ray, v, y.state)));
    const Rgb light = y.weight * f * seen * (lens->weight * w / (chance * float(light_paths_)));
    return std::pair{Contribution{light, layer, int(s), 1, w}, lens->film_position};
}

template <bool Media>
Contribution Strategies<Media>::hit_light(std::size_t t) {
    const PathVertex& z = eye_.vertices[t - 1];
    const Vec3 direction = -z.scattering.wo;
    LightPoint point;
    Rgb radiance(0.0f);
    if (z.infinite) {
        point.emitter = scene_.environment();
        if (point.emitter) radiance = point.emitter->environment(direction);
    } else if (z.scattering.on_surface() && z.scattering.hit.shape->emitter) {
        point.emitter = z.scattering.hit.shape->emitter.get();
        radiance = point.emitter->radiance(z.scattering.hit, z.scattering.wo);
    }
    if (!point.emitter || is_black(radiance)) return {};
    point.wi = direction;
    if (z.infinite)
        point.position = eye_.vertices[t - 2].scattering.position;
    else
        point.position = z.scattering.position, point.normal = z.scattering.hit.geometric_normal;
    light_point_ = point;
    double others = 0.0;
    if (t >= 3 && settings_.heuristic != Heuristic::none) {
        const PathVertex& receiver = eye_.vertices[t - 2];
        const ScatteringVertex& v = receiver.scattering;
        const double sampled =
            receiver.delta ? 0.0 : ends_.sampled(v.light_receiver(), point, z.distance_squared);
        const LightEnds::Start start = ends_.start(point);
        const double by_light =
            start.of(v.geometric_cosine(direction), z.distance_squared, z.infinite) * z.edge;
        others = mis_term(settings_.heuristic, sampled / z.density) * eye_.connection_term() +
                 mis_term(settings_.heuristic, start.light / z.density) * eye_.through(t - 2, by_light, z);
    }
    const auto w = float(connection_weight(1.0, 0.0, others));
    return {z.weight * radiance * w, layer_of(0, t), 0, int(t), w};
}

template <bool Media>
Contribution Strategies<Media>::draw_light(std::size_t t, float u_light, const Vec2& u) {
    const PathVertex& z = eye_.vertices[t - 1];
    const ScatteringVertex& v = z.scattering;
    const LightChoice choice = scene_.choose_light(v.light_receiver(), u_light);
    if (!choice.emitter || choice.emitter->traits().kind == EmitterKind::medium) return {};
    const auto light = choice.emitter->sample_direct(v.position, u);
    if (!light) return {};
    const Rgb f = v.eval_cos(light->wi, TransportMode::radiance);
    if (is_black(f)) return {};
    LightPoint point{choice.emitter, v.position, light->normal, light->wi};
    const bool infinite = point.infinite();
    if (!infinite) point.position += light->distance * light->wi;
    light_point_ = point;
    const double d2 = infinite ? 1.0 : double(light->distance) * double(light->distance);
    const double measure = point.area_measure(d2);
    const double sampled =
        double(choice.probability) * (light->delta ? 1.0 : double(light->pdf_solid_angle) * measure);
    const bool can_be_hit = choice.emitter->traits().can_be_hit();
    const double to_light =
        can_be_hit ? double(v.pdf_solid_angle(light->wi, TransportMode::radiance)) * measure : 0.0;
    const LightEnds::Start start = ends_.start(point);
    const double by_light = start.of(v.geometric_cosine(light->wi), d2, infinite);
    const double before = reverse_of_previous(eye_, t - 1, light->wi, TransportMode::radiance);
    const auto weight_with = [&](double edge) {
        return connection_weight(own_term(effort()), mis_term(settings_.heuristic, to_light * edge / sampled),
                                 mis_term(settings_.heuristic, start.light / sampled) *
                                     eye_.others(t - 1, by_light * edge, before, edge, light->wi)) /
               effort();
    };
    const float chance = worth_a_ray(weight_with(guessed_edge(z.sigma_here, double(light->distance))));
    if (!(chance > 0.0f)) return {};
    const Vec3 origin = v.ray_origin(light->wi);
    const float end = shadow_end(origin, light->distance);
    const Ray ray{origin, light->wi, 0.0f, light->delta ? light->distance : end};
    const Rgb seen = between(ray, v, z.state, end);
    if (is_black(seen)) return {};
    const double w = weight_with(edge_along(ray, v, z.state));
    return {z.weight * f * light->weight * seen * float(w / double(choice.probability * chance)),
            layer_of(1, t), 1, int(t), float(w)};
}

template <bool Media>
bool Strategies<Media>::prepare(std::size_t s, std::size_t t, Connection& c) const {
    const PathVertex &y = light_.vertices[s - 1], &z = eye_.vertices[t - 1];
    if (!y.scattering.connectable()) return false;
    const Vec3d d = Vec3d(y.scattering.position) - Vec3d(z.scattering.position);
    const double d2 = glm::dot(d, d);
    if (!(d2 > 0.0)) return false;
    c.s = s, c.wi = Vec3(d / std::sqrt(d2));
    // f* G f* (Veach 1997, Eq. 10.7), cosines within.
    const Rgb f_eye = z.scattering.eval_cos(c.wi, TransportMode::radiance);
    if (is_black(f_eye)) return false;
    const Rgb f_light = y.scattering.eval_cos(-c.wi, TransportMode::power) *
                        adjoint_correction(y.scattering, y.scattering.wo, -c.wi);
    if (is_black(f_light)) return false;
    c.light = z.weight * f_eye * f_light * y.weight * float(1.0 / d2);
    c.to_light =
        double(z.scattering.pdf_solid_angle(c.wi, TransportMode::radiance)) * y.area_measure(c.wi, d2);
    c.to_eye = double(y.scattering.pdf_solid_angle(-c.wi, TransportMode::power)) * z.area_measure(c.wi, d2);
    c.before_light = reverse_of_previous(light_, s - 1, -c.wi, TransportMode::power);
    c.before_eye = reverse_of_previous(eye_, t - 1, c.wi, TransportMode::radiance);
    c.guessed = guessed_edge(0.5 * (y.sigma_here + z.sigma_here), std::sqrt(d2));
    c.expected = average(c.light) * float(weight_of(c, t, c.guessed) * c.guessed);
    return true;
}

template <bool Media>
double Strategies<Media>::weight_of(const Connection& c, std::size_t t, double edge) const {
    if (settings_.heuristic == Heuristic::none) return 1.0 / effort();
    return connection_weight(own_term(effort()),
                             light_.others(c.s - 1, c.to_light * edge, c.before_light, edge, c.wi),
                             eye_.others(t - 1, c.to_eye * edge, c.before_eye, edge, c.wi)) /
           effort();
}

template <bool Media>
Contribution Strategies<Media>::test(const Connection& c, std::size_t t) {
    const PathVertex &y = light_.vertices[c.s - 1], &z = eye_.vertices[t - 1];
    const float chance = worth_a_ray(weight_of(c, t, c.guessed));
    if (!(chance > 0.0f)) return {};
    const Ray segment = segment_between(z.scattering, y.scattering, c.wi);
    const Rgb seen = between(segment, z.scattering, z.state, shadow_end(segment.origin, segment.t_max));
    if (is_black(seen)) return {};
    const auto w = float(weight_of(c, t, edge_along(segment, z.scattering, z.state)));
    return {c.light * seen * (w / chance), layer_of(c.s, t), int(c.s), int(t), w};
}

template class Strategies<true>;
template class Strategies<false>;

}  // namespace mote::integrators
