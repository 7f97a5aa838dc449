// Light that one eye subpath finds by merging with the light subpaths of a pass.
//
// With y the light's vertex, z the eye's, both weights with the albedo of their collision, and w the MIS
// weight,
//   surface photon         y z f / (n pi r^2) w
//   point-point 3D         y z f / (n (4/3) pi r^3 sigma_s) w            the albedo counts once
//   photon, query beam 2D  y Z f / (n pi r^2) w               Z: the eye path's weight there (BeamWeight)
//   beam, query beam 1D    Y Z sigma_s f / (n 2 r sin) w      Y: the light path's
// In terms of K (merge_kernels.h) the factor is w / K times 1, sigma_t / sigma_s, spare, and sigma_s /
// sigma_t times both beams' spare; spare = 1 / tau of the weights for long beams, else 1. Z and Y may be
// estimates; the weights' tau is the function of the edge that all techniques have.
#pragma once

#include "gathering/photon_maps/surface_photon_map.h"
#include "integrators/bidirectional/strategies.h"
#include "integrators/upbp/efforts.h"
#include "integrators/upbp/light_beams.h"
#include "integrators/upbp/light_vertices.h"

namespace mote::integrators {

template <bool Media>
class Merges {
  public:
    /// Keeps references. `strategies` traces the eye path.
    Merges(const core::Scene& scene, const LightEnds& ends, const Strategies<Media>& strategies,
           const LightVertices& lights, const LightBeams& beams, const BidirectionalSettings& settings,
           core::WalkContext& context)
        : scene_(scene),
          ends_(ends),
          strategies_(strategies),
          lights_(lights),
          beams_(beams),
          settings_(settings),
          context_(context) {}

    /// Merges at the last vertex of the eye path and along its last edge: found(Contribution).
    template <typename Found>
    void after_step(const SubpathWalk<Media>& walk, bool continues, const Found& found) {
        if constexpr (Media)
            for (const Beam& beam : walk.beams()) {
                start_on_beam(beam, on_eye_);
                on_eye_.connection = beam.index == 1 ? strategies_.lens_connection()
                                                     : strategies_.eye_path().connection_term();
                seek(Merge::point_beam_2d, [&] { with_points(beam, found); });
                seek(Merge::beam_beam_1d, [&] { with_beams(beam, found); });
            }
        const Subpath& eye = strategies_.eye_path();
        if (!continues || eye.vertices.back().infinite) return;
        const core::ScatteringVertex& z = eye.vertices.back().scattering;
        if (!z.connectable()) return;
        const Merge technique = z.on_surface() ? Merge::surface : Merge::point_point_3d;
        seek(technique, [&] { at_vertex(technique, eye, found); });
    }
    const TechniqueWork& work() const { return work_; }  ///< so far

  private:
    /// Calls merges() if the query is sampled, and counts what that takes.
    template <typename F>
    void seek(Merge technique, const F& merges) {
        if (!settings_.merging.uses(technique)) return;
        ++query_;
        if (!settings_.merging.sampled(technique, context_.rng)) return;
        const std::uint64_t lookups = context_.tracking.lookups;
        tested_ = found_ = 0, technique_ = technique;
        merges();
        work_.add_query(technique, tested_, found_, context_.tracking.lookups - lookups);
    }
    template <typename Found>
    void at_vertex(Merge technique, const Subpath& eye, const Found& found) {
        const PathVertex& z = eye.vertices.back();
        const bool surface = technique == Merge::surface;
        const MergeVertex at{surface, true, z.sigma_t};
        const double kernel = merge_kernel(technique, at, settings_.merging);
        lights_.for_each_near(surface, z.scattering.position,
                              settings_.merging.radius[std::size_t(technique)], near_,
                              [&](const LightVertex& v) {
                                  ++found_;
                                  const PathVertex& y = lights_.vertex(v);
                                  if (surface ? !same_side(y, z) : y.scattering.phase != z.scattering.phase)
                                      return;
                                  const core::Rgb once = surface ? core::Rgb(1.0f) : spared_albedo(z);
                                  add(lights_.path(v), v.index, y, z, eye.size() - 1, kernel, once, found);
                              });
    }
    template <typename Found>
    void with_points(const Beam& beam, const Found& found) {
        const BeamLength length = settings_.merging.eye_beams;
        PathVertex& z = on_eye_;
        BeamWeight weight(beam, length, context_);
        lights_.for_each_along(query_on(beam), near_beam_, [&](const LightVertex& v, float t) {
            ++found_;
            const PathVertex& y = lights_.vertex(v);
            z.weight = weight.advance_to(t);
            if (core::is_black(z.weight) || !weight.medium()) return;
            if (&weight.medium()->phase() != y.scattering.phase) return;
            if (!wanted(v.index, z, beam.index)) return;
            move_on_beam(scene_, strategies_.eye_path(), beam, t, context_.tracking, z);
            copy_medium(y, z);
            const double kernel =
                merge_kernel(Merge::point_beam_2d, {false, true, z.sigma_t, 1.0, z.edge}, settings_.merging);
            add(lights_.path(v), v.index, y, z, beam.index, kernel,
                core::Rgb(float(spared_density(length, z.edge))), found);
        });
    }
    template <typename Found>
    void with_beams(const Beam& beam, const Found& found) {
        const MergeSettings& merging = settings_.merging;
        PathVertex &y = on_light_, &z = on_eye_;
        BeamWeight weight(beam, merging.eye_beams, context_);
        tested_ += beams_.crossings(query_on(beam), crossings_);
        for (const LightBeams::Hit& hit : crossings_) {
            ++found_;
            const LightBeam& light = beams_.beam(hit);
            if (!strategies_.allowed(light.beam.index, beam.index + 1)) continue;
            z.weight = weight.advance_to(hit.t);
            const core::Medium* medium = weight.medium();
            if (core::is_black(z.weight) || !medium) continue;
            BeamWeight light_weight(light.beam, merging.light_beams, context_);
            y.weight = light_weight.advance_to(hit.s);
            if (core::is_black(y.weight) || light_weight.medium() != medium) continue;
            if (!wanted(light.beam.index, z, beam.index)) continue;
            z.scattering.phase = &medium->phase();
            move_on_beam(scene_, strategies_.eye_path(), beam, hit.t, context_.tracking, z);
            set_merges(strategies_.eye_path(), medium->coefficients(z.scattering.position), z);
            if (!(z.sigma_t > 0.0)) continue;
            move_on_light_beam(light, hit.s);
            copy_medium(z, y);
            const double kernel = merge_kernel(
                Merge::beam_beam_1d, {false, true, z.sigma_t, y.edge, z.edge, double(hit.sine)}, merging);
            const double spare = spared_density(merging.light_beams, y.edge) *
                                 spared_density(merging.eye_beams, z.edge) / z.sigma_t;
            add(beams_.path(light), light.beam.index, y, z, beam.index, kernel, z.sigma_s * float(spare),
                found);
        }
    }
    void move_on_light_beam(const LightBeam& light, float s) {
        PathVertex& y = on_light_;
        const Subpath& path = beams_.path(light);
        start_on_beam(light.beam, y);
        y.scattering.phase = on_eye_.scattering.phase;
        move_on_beam(scene_, path, light.beam, s, context_.tracking, y);
        y.connection =
            light.beam.index > 1 ? path.connection_term() : light_connection(ends_, y, light.start, path);
    }
    core::Ray query_on(const Beam& beam) const {
        core::Ray ray = beam.ray;
        ray.t_max = beam.end(settings_.merging.eye_beams);
        return ray;
    }
    static void copy_medium(const PathVertex& from, PathVertex& to) {
        to.scattering.phase = from.scattering.phase;
        to.sigma_t = from.sigma_t, to.sigma_s = from.sigma_s;
        to.point_merges = from.point_merges, to.point_beam_merges = from.point_beam_merges;
        to.beam_beam_merges = from.beam_beam_merges;
    }

    /// Merges of vertex i of a light path with vertex j of the eye path, z, find paths that are.
    bool wanted(std::size_t i, const PathVertex& z, std::size_t j) const {
        return strategies_.allowed(i, j + 1) && settings_.limits.wanted[Strategies<Media>::layer_of(i, z)];
    }

    template <typename Found>
    void add(const Subpath& light, std::size_t i, const PathVertex& y, const PathVertex& z, std::size_t j,
             double kernel, const core::Rgb& factor, const Found& found) {
        if (!wanted(i, z, j)) return;
        const core::Rgb f = scattered(y, z);
        if (core::is_black(f)) return;
        const double over = weight_over_kernel(light, i, y, strategies_.eye_path(), j, z, kernel);
        Contribution c;
        c.light = y.weight * z.weight * f * factor * float(over);
        c.layer = Strategies<Media>::layer_of(i, z), c.weight = float(over * kernel);
        c.merge = technique_, c.query = query_;
        found(c);
    }

    /// f* for the direction that the light's vertex came from. On surfaces photons measure light per area of
    /// the true surface; a mask stops both subpaths by chance, and is there once.
    static core::Rgb scattered(const PathVertex& y, const PathVertex& z) {
        const core::Vec3 wi = y.scattering.wo;
        const core::Rgb f = z.scattering.eval_cos(wi, core::TransportMode::radiance);
        if (!z.scattering.on_surface()) return f;
        const float geometric = z.scattering.geometric_cosine(wi);
        return geometric > 0.0f ? f / (geometric * y.scattering.stop_chance) : core::Rgb(0.0f);
    }
    static bool same_side(const PathVertex& y, const PathVertex& z) {
        return gathering::photon_counts(y.scattering.hit.geometric_normal, z.scattering.hit.geometric_normal);
    }
    /// sigma_t / sigma_s, 0 where nothing scatters.
    static core::Rgb spared_albedo(const PathVertex& z) {
        core::Rgb once(0.0f);
        for (int c = 0; c < 3; ++c)
            if (z.sigma_s[c] > 0.0f) once[c] = float(z.sigma_t / double(z.sigma_s[c]));
        return once;
    }
    double weight_over_kernel(const Subpath& light, std::size_t i, const PathVertex& y, const Subpath& eye,
                              std::size_t j, const PathVertex& z, double kernel) const {
        MergedVertex m;
        m.from_light = y.density, m.from_eye = z.density;
        m.connection_light = light.technique(i, y, true), m.connection_eye = eye.technique(j, z, true);
        const double before_y =
            density_of_previous(y, light.vertices[i - 1], z.scattering.wo, core::TransportMode::power, false);
        const double before_z = density_of_previous(z, eye.vertices[j - 1], y.scattering.wo,
                                                    core::TransportMode::radiance, false);
        m.before_light = light.through(i - 1, before_y, y);
        m.before_eye = eye.through(j - 1, before_z, z);
        m.merges = eye.merges(z, y.edge, y.scattering.wo);
        return merge_weight_over_kernel(settings_.heuristic, m, kernel);
    }

    const core::Scene& scene_;
    const LightEnds& ends_;
    const Strategies<Media>& strategies_;
    const LightVertices& lights_;
    const LightBeams& beams_;
    const BidirectionalSettings& settings_;
    core::WalkContext& context_;
    std::vector<core::KdTree::Neighbour> near_;
    std::vector<core::RayFacingDiscs::Hit> near_beam_;
    std::vector<LightBeams::Hit> crossings_;
    PathVertex on_eye_, on_light_;        ///< of beams; reused
    Merge technique_{};                   ///< of this query
    std::uint32_t query_ = 0;             ///< queries so far
    std::size_t tested_ = 0, found_ = 0;  ///< by this query
    TechniqueWork work_;
};

}  // namespace mote::integrators
