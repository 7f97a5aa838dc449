#include "integrators/bidirectional/subpath_walk.h"

#include "lights/virtual_lights/light_path.h"

namespace mote::integrators {

using namespace core;

template <bool Media>
bool SubpathWalk<Media>::survives(std::size_t vertex) {
    const int depth = int(vertex);
    if (depth < limits_.rr_depth) return true;
    const Rgb now = channel_throughput();
    const bool eye = mode_ == TransportMode::radiance;
    const float left = eye ? max_component(now) * sqr(eta_) : lights::remaining_power(now, first_);
    const float q = survival_chance(left, depth, eye ? long_eye_path : long_light_path);
    if (!(context_.rng.next_float() < q)) return false;
    weights_.throughput /= q;
    return true;
}

/// Leaves the last vertex by a direction of its own. Returns false where the path ends instead.
template <bool Media>
bool SubpathWalk<Media>::scatter() {
    PathVertex& vertex = path_.vertices.back();
    const ScatteringVertex& v = vertex.scattering;
    if (vertex.infinite || !survives(path_.size() - 1)) return false;
    const float u_lobe = sampler_.next_1d();
    const auto next = v.sample(u_lobe, sampler_.next_2d(), mode_);
    if (!next) return false;
    const bool eye = mode_ == TransportMode::radiance;
    // A light path's shading normals (Veach 1997, Eq. 5.19).
    weights_.throughput *= eye ? next->weight : next->weight * adjoint_correction(v, v.wo, next->wi);
    if (is_black(weights_.throughput)) return false;
    vertex.delta = next->delta;
    density_ = next->delta ? 1.0 : double(next->pdf_solid_angle), parallel_ = false;
    eta_ *= next->eta;
    if (Media && v.on_surface()) state_ = v.state_towards(state_, next->wi);
    if (!next->delta || scatterings_ > 0) {
        if (scatterings_ == 0) surface_first_ = v.on_surface();
        ++scatterings_;
    }
    ray_ = Ray{v.ray_origin(next->wi), next->wi};
    return true;
}

template <bool Media>
bool SubpathWalk<Media>::keeps_beams() const {
    const bool eye = mode_ == TransportMode::radiance;
    return Media &&
           (path_.merging.uses(Merge::beam_beam_1d) || (eye && path_.merging.uses(Merge::point_beam_2d)));
}

template <bool Media>
void SubpathWalk<Media>::begin_beam() {
    Beam& beam = beams_.emplace_back();
    beam.ray = ray_, beam.state = state_, beam.weights = weights_;
    beam.index = path_.size(), beam.density = density_, beam.parallel = parallel_;
    beam.scatterings = scatterings_, beam.surface_first = surface_first_;
    if (beam.index >= 2)
        beam.others =
            path_.others_before(beam.index, density_of_previous(path_, beam.index - 1, ray_.direction, mode_,
                                                                path_.vertices[beam.index - 1].delta));
}

template <bool Media>
WalkEvent SubpathWalk<Media>::go() {
    Rgb emitted(0.0f);
    const bool keeps = keeps_beams();
    if (keeps) begin_beam();
    const WalkEvent event = walk<Media>(scene_, ray_, state_, weights_, emitted, context_);
    if (keeps) {
        Beam& beam = beams_.back();
        beam.ray.t_max = event.surface_distance;
        beam.reached = std::min(event.distance, event.surface_distance);
        beam.boundaries = context_.boundary_hits;
    }
    emitted_ += emitted;
    return event;
}

template <bool Media>
bool SubpathWalk<Media>::advance() {
    emitted_ = Rgb(0.0f);
    beams_.clear();
    const std::size_t k = path_.size();
    if (limits_.max_vertices >= 0 && int(k) > limits_.max_vertices) return false;
    if (k > 1 && !scatter()) return false;
    const MediumState start = state_;
    WalkEvent event = go();
    const bool hides = limits_.passes_lights && k == 1;
    while (hides && event.kind == WalkEvent::Kind::surface && event.hit.shape->emitter) {
        const ScatteringVertex light = make_vertex(event, ray_);
        if constexpr (Media) state_ = light.state_towards(state_, ray_.direction);
        ray_ = {light.ray_origin(ray_.direction), ray_.direction, 0.0f, ray_.t_max - event.distance};
        event = go();
    }
    const bool escaped = event.kind == WalkEvent::Kind::escaped;
    if (escaped && (mode_ == TransportMode::power || hides)) return false;
    if (is_black(weights_.throughput)) return false;
    append(event, start);
    return true;
}

template <bool Media>
void SubpathWalk<Media>::append(const WalkEvent& event, const MediumState& start) {
    const std::size_t k = path_.size();
    path_.vertices.emplace_back();
    PathVertex& vertex = path_.vertices[k];
    const PathVertex& previous = path_.vertices[k - 1];
    vertex.state = state_, vertex.weight = channel_throughput();
    vertex.connection = path_.connection_term();
    vertex.infinite = event.kind == WalkEvent::Kind::escaped;
    if (vertex.infinite)
        vertex.scattering.wo = -ray_.direction;
    else
        vertex.scattering = make_vertex(event, ray_);
    vertex.scatterings = scatterings_, vertex.surface_first = surface_first_;
    if (!vertex.infinite && !(previous.infinite || parallel_)) {
        const Vec3d d = Vec3d(vertex.scattering.position) - Vec3d(previous.scattering.position);
        vertex.distance_squared = std::max(glm::dot(d, d), 1e-40);
    }
    MediumCoefficients here;
    if constexpr (Media) {
        // From this end, or, of light from infinity, from the other: there an edge has one end only.
        Ray edge = ray_;
        const bool from_infinity = previous.infinite;
        if (from_infinity)
            edge = {vertex.scattering.ray_origin(-ray_.direction), -ray_.direction};
        else if (!vertex.infinite && k > 1)
            edge = segment_between(previous.scattering, vertex.scattering, ray_.direction);
        else if (!vertex.infinite)
            edge.t_max = event.distance;
        vertex.edge = edge_transmittance(scene_, edge, from_infinity ? state_ : start, context_.tracking);
        if (const Medium* medium = state_.current(); medium && !vertex.infinite)
            here = medium->coefficients(vertex.scattering.position);
        vertex.sigma_here = double(average(here.sigma_t));
    }
    vertex.density = density_ * vertex.area_measure(ray_.direction, vertex.distance_squared) * vertex.edge;
    if (path_.merging.any() && !vertex.infinite)
        set_merges(path_, event.medium ? here : MediumCoefficients{}, vertex);
    if (k >= 2)
        vertex.others =
            path_.others_before(k, density_of_previous(path_, k - 1, ray_.direction, mode_, previous.delta));
}

template class SubpathWalk<true>;
template class SubpathWalk<false>;

}  // namespace mote::integrators
