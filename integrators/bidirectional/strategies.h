// The strategies of bidirectional path tracing: a light path, an eye path, and every way to join them.
#pragma once

#include "core/scene/scene.h"
#include "integrators/bidirectional/light_ends.h"
#include "integrators/bidirectional/splats.h"
#include "integrators/bidirectional/subpath_walk.h"
#include "integrators/eye_path/eye_path_limits.h"
#include "integrators/eye_path/eye_ray.h"

namespace mote::integrators {

struct BidirectionalSettings {
    EyePathLimits limits;
    Heuristic heuristic = Heuristic::power;
    bool all_connections = false;  ///< test all of them, not one sampled for each eye vertex, and whatever
                                   ///< their weight
    bool connections = true;       ///< false: subpaths are merged only; light seen directly is found as ever
    MergeSettings merging;         ///< none by default
    int strategies = 0;  ///< paths of up to so many edges are also sorted by their strategy; 0: none
};

/// Light found by one technique (s, t), weighted, and its layer.
struct Contribution {
    core::Rgb light{0.0f};
    Transport layer{};
    int s = 0, t = 0;
    float weight = 0.0f;  ///< of multiple importance sampling, in `light`; of connections over their effort
    std::optional<Merge> merge{};  ///< the technique that found it, with s = t = 0; none: (s, t)
    std::uint32_t query = 0;       ///< merges of one query of an eye path are sought together
};

/// The chance with which a ray is spent on what has this weight: below 1 where other techniques find it
/// better.
inline float chance_of_ray(float weight) {
    constexpr float worth = 0.25f;
    return std::min(1.0f, weight / worth);
}

/// PathVertex::connection of the first vertex behind the light, `start`, which is vertex 0 of `path`.
double light_connection(const LightEnds& ends, const PathVertex& first, const LightPoint& start,
                        const Subpath& path);

/// Counts of connections, for their work.
struct ConnectionCounts {
    std::uint64_t pairs = 0;    ///< of vertices, whose light is known but for what is in between
    std::uint64_t rays = 0;     ///< for occluders and boundaries
    std::uint64_t lookups = 0;  ///< of media
};

template <bool Media>
class Strategies {
  public:
    /// `light_paths`: how many are traced for one ray of each pixel. `filter_radius` [pixels]: how far
    /// outside of the film a pixel still sees.
    Strategies(const core::Scene& scene, const LightEnds& ends, const BidirectionalSettings& settings,
               std::uint32_t light_paths, float filter_radius, core::WalkContext& context)
        : scene_(scene),
          ends_(ends),
          settings_(settings),
          light_paths_(light_paths),
          filter_radius_(filter_radius),
          context_(context) {
        light_.heuristic = eye_.heuristic = settings.heuristic;
        light_.connects = eye_.connects = settings.connections;
        light_.merging = eye_.merging = settings.merging;
        light_.from_light = true;
    }

    /// Traces a light path, and joins its vertices to the lens (t = 1): splat(Contribution, film position).
    template <typename Splat>
    void trace_light_path(core::Sampler& sampler, const Splat& splat) {
        trace_light_path(sampler, splat, [](SubpathWalk<Media>&) {});
    }
    /// Also calls after_step(walk) after each edge, a vertex at its end or not.
    template <typename Splat, typename AfterStep>
    void trace_light_path(core::Sampler& sampler, const Splat& splat, const AfterStep& after_step);
    /// Traces an eye path, and adds what it finds with all vertices of the last light path:
    /// found(Contribution).
    template <typename Found>
    void trace_eye_path(const EyeRay& eye, const Found& found) {
        trace_eye_path(eye, found, [](const SubpathWalk<Media>&, bool) {});
    }
    /// Also calls after_step(walk, whether there is a new vertex) after each edge.
    template <typename Found, typename AfterStep>
    void trace_eye_path(const EyeRay& eye, const Found& found, const AfterStep& after_step);
    /// A light path that was traced before, to be joined to eye paths.
    void take_light_path(const Subpath& path) {
        light_.vertices = path.vertices, light_.without = path.without;
    }

    /// Layer of light that reaches eye vertex t - 1, `z`, after s scatterings, at which it scatters once
    /// more.
    static Transport layer_of(std::size_t s, const PathVertex& z) {
        if (s == 0) return transport_layer(z.scatterings, z.surface_first);
        const bool surface = z.scatterings == 0 ? z.scattering.on_surface() : z.surface_first;
        return transport_layer(z.scatterings + int(s), surface);
    }
    /// Paths of s + t vertices are not too long.
    bool allowed(std::size_t s, std::size_t t) const {
        return settings_.limits.max_depth < 0 || int(s + t) - 1 <= settings_.limits.max_depth;
    }

    // Valid within `splat` and `found`:
    const Subpath& light_path() const { return light_; }
    const Subpath& eye_path() const { return eye_; }
    /// PathVertex::connection of the first eye vertex: all light paths are joined to the lens.
    double lens_connection() const {
        return settings_.limits.hide_emitters ? 0.0 : mis_term(settings_.heuristic, light_paths_);
    }
    const LightPoint& light_point() const { return light_point_; }  ///< that was sampled, or hit
    const LightPoint& light_start() const { return light_start_; }  ///< of the light path
    const core::Vec3& lens_point() const { return lens_point_; }    ///< that a light path is joined to

    const ConnectionCounts& connection_counts() const { return counts_; }  ///< of eye vertices so far

  private:
    bool start_light_path(core::Sampler& sampler, SubpathWalk<Media>& walk);
    void finish_light_start();
    std::optional<std::pair<Contribution, core::Vec2>> join_to_lens(std::size_t s, const core::Vec2& u_lens);
    Contribution hit_light(std::size_t t);
    Contribution draw_light(std::size_t t, float u_light, const core::Vec2& u);
    /// A connection to light vertex s - 1 before it is known whether anything is in between.
    struct Connection {
        std::size_t s = 0;
        core::Vec3 wi{0.0f};              ///< unit, from the eye vertex
        core::Rgb light{0.0f};            ///< unoccluded and unweighted
        double to_light, to_eye;          ///< densities of the vertices from the other end, without tau
        double before_light, before_eye;  ///< of those before them
        double guessed = 1.0;             ///< tau of the edge
        float expected = 0.0f;            ///< its weight in the choice
    };
    bool prepare(std::size_t s, std::size_t t, Connection& connection) const;
    /// Over the effort of connections.
    double weight_of(const Connection& c, std::size_t t, double edge) const;
    Contribution test(const Connection& connection, std::size_t t);
    template <typename Found>
    void connect(std::size_t t, const Found& found);

    Transport layer_of(std::size_t s, std::size_t t) const { return layer_of(s, eye_.vertices[t - 1]); }
    bool wanted(std::size_t s, std::size_t t) const { return settings_.limits.wanted[layer_of(s, t)]; }
    /// chance_of_ray(), by the weight with a guess of the edge's tau; 0: not this time. An effort is no
    /// reason against the ray: it was won already.
    float worth_a_ray(double weight);
    /// h of what a technique's own density has beyond the vertices'; 1 where every technique counts in full.
    double own_term(double ratio) const {
        return settings_.heuristic == Heuristic::none ? 1.0 : mis_term(settings_.heuristic, ratio);
    }
    double effort() const { return settings_.merging.effort[by_connection]; }
    template <typename Found>
    void connect_eye_vertex(std::size_t t, float u_light, const core::Vec2& u, const Found& found);
    /// A guess of tau of an edge through media with this extinction [1/m], before it is marched: it decides
    /// how often the edge is tested. Never so small that light is rare and bright where it is wrong.
    static double guessed_edge(double sigma, double distance) {
        constexpr double least = 1.0 / 32.0;
        return Media && sigma > 0.0 ? least + (1.0 - least) * std::exp(-sigma * distance) : 1.0;
    }
    double edge_along(const core::Ray& ray, const core::ScatteringVertex& from,
                      const core::MediumState& state);
    /// Visibility times an unbiased estimate of the transmittance.
    core::Rgb between(const core::Ray& segment, const core::ScatteringVertex& from,
                      const core::MediumState& state, float visible_to);
    double reverse_of_previous(const Subpath& path, std::size_t k, const core::Vec3& from,
                               core::TransportMode mode) const {
        return density_of_previous(path, k, from, mode, false);
    }

    const core::Scene& scene_;
    const LightEnds& ends_;
    const BidirectionalSettings& settings_;
    double light_paths_;
    float filter_radius_;
    core::WalkContext& context_;
    bool pinhole_ = scene_.camera().traits().delta_position;
    Subpath light_, eye_;
    std::vector<Connection> connections_;
    ConnectionCounts counts_;
    LightPoint light_start_, light_point_;
    core::Vec3 lens_point_{0.0f};
};

template <bool Media>
template <typename Splat, typename AfterStep>
void Strategies<Media>::trace_light_path(core::Sampler& sampler, const Splat& splat,
                                         const AfterStep& after_step) {
    light_.vertices.clear();
    const int max_depth = settings_.limits.max_depth;
    SubpathWalk<Media> walk(
        scene_, core::TransportMode::power,
        {max_depth < 0 ? -1 : std::max(0, max_depth - 1), std::min(2, settings_.limits.rr_depth)}, light_,
        sampler, context_);
    if (!start_light_path(sampler, walk)) return;
    while (true) {
        const bool continues = walk.advance();
        if (continues && light_.size() == 2) finish_light_start();
        after_step(walk);
        if (!continues) return;
        if (settings_.limits.hide_emitters || !settings_.connections)
            continue;  // eye rays pass lights, connections to the lens do not
        const core::Vec2 u_lens = pinhole_ ? core::Vec2(0.5f) : sampler.next_2d();
        if (const auto joined = join_to_lens(light_.size(), u_lens)) splat(joined->first, joined->second);
    }
}

template <bool Media>
template <typename Found, typename AfterStep>
void Strategies<Media>::trace_eye_path(const EyeRay& eye, const Found& found, const AfterStep& after_step) {
    eye_.vertices.assign(1, {});
    eye_.vertices[0].scattering.position = eye.ray.origin;
    core::PathWeights weights;
    core::MediumState state;
    if constexpr (Media) {
        weights.hero = core::sample_hero(context_.rng);
        state = scene_.eye_medium_state(eye.ray);
    }
    const auto importance = scene_.camera().importance(eye.ray.origin, eye.ray.direction, filter_radius_);
    const bool parallel = scene_.camera().traits().delta_direction;
    // Its density is that of one ray a pixel (camera.h).
    const double density =
        !importance ? 1.0 : double(parallel ? importance->pdf_area : importance->pdf_solid_angle);
    core::Sampler sampler = eye.sampler;
    const EyePathLimits& limits = settings_.limits;
    SubpathWalk<Media> walk(scene_, core::TransportMode::radiance,
                            {limits.max_depth, limits.rr_depth, limits.hide_emitters}, eye_, sampler,
                            context_);
    walk.start(eye.ray, density, parallel, weights, state);
    while (true) {
        const bool continues = walk.advance();
        const PathVertex& last = eye_.vertices.back();
        // That of media is found by no other technique.
        if (Media && !core::is_black(walk.emitted()))
            found(Contribution{walk.emitted(), walk.emission_layer(), 0, int(eye_.size()) + !continues});
        if (continues && eye_.size() == 2) eye_.vertices[1].connection = lens_connection();
        after_step(walk, continues);
        if (!continues) return;
        const std::size_t t = eye_.size();
        // No merge finds what only mirrors and glass reflect.
        if (wanted(0, t) && (settings_.connections || last.scatterings == 0)) found(hit_light(t));
        if (last.infinite) return;
        const core::Vec2 choice = sampler.next_2d(), u = sampler.next_2d();
        if (!last.scattering.connectable() || !settings_.connections) continue;
        if (settings_.merging.connections_sampled(context_.rng)) connect_eye_vertex(t, choice.x, u, found);
    }
}

/// Joins the last eye vertex to a light and to the light path.
template <bool Media>
template <typename Found>
void Strategies<Media>::connect_eye_vertex(std::size_t t, float u_light, const core::Vec2& u,
                                           const Found& found) {
    const core::RayCounters& rays = context_.rays;
    const std::uint64_t rays_before = rays.occlusion + rays.boundary,
                        lookups_before = context_.tracking.lookups;
    if (allowed(1, t) && wanted(1, t)) found(draw_light(t, u_light, u));
    connect(t, found);
    counts_.rays += rays.occlusion + rays.boundary - rays_before;
    counts_.lookups += context_.tracking.lookups - lookups_before;
}

/// Joins the last eye vertex to the light path. Of all connections one is tested, sampled by what it would
/// bring if no surface were in between, with a guess of the transmittance: shadow rays are then as many as
/// vertices, not pairs of them.
template <bool Media>
template <typename Found>
void Strategies<Media>::connect(std::size_t t, const Found& found) {
    connections_.clear();
    float sum = 0.0f;
    for (std::size_t s = 2; s <= light_.size() && allowed(s, t); ++s) {
        Connection c;
        if (!wanted(s, t) || !prepare(s, t, c)) continue;
        ++counts_.pairs;
        if (settings_.all_connections)
            found(test(c, t));
        else if (c.expected > 0.0f)
            sum += c.expected, connections_.push_back(c);
    }
    if (connections_.empty()) return;
    float left = context_.rng.next_float() * sum;
    std::size_t i = 0;
    while (i + 1 < connections_.size() && left >= connections_[i].expected)
        left -= connections_[i++].expected;
    Connection& sampled = connections_[i];
    sampled.light *= sum / sampled.expected;
    found(test(sampled, t));
}

}  // namespace mote::integrators
