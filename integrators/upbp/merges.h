// Light that one eye subpath finds by merging with the light subpaths of a pass.
//
// With y the light's vertex, z the eye's, both weights with the albedo of their collision, and w the MIS
// weight,
//   surface photon         y z f / (n pi r^2) w
//   point-point 3D         y z f / (n (4/3) pi r^3 sigma_s) w            the albedo counts once
//   photon, query beam 2D  y T tau f / (n pi r^2) w                      T: the eye path's weight at the ray
// In terms of K (merge_kernels.h) the factor is w / K times 1, sigma_t / sigma_s, and 1 / tau of the weights.
// tau of the light itself may be an estimate, the same that photon maps use; the weights' is the function of
// the edge that all techniques have.
#pragma once

#include "core/scene/transmittance_along.h"
#include "gathering/photon_maps/surface_photon_map.h"
#include "integrators/bidirectional/strategies.h"
#include "integrators/upbp/light_vertices.h"

namespace mote::integrators {

template <bool Media>
class Merges {
  public:
    /// Keeps references. `strategies` traces the eye path.
    Merges(const Strategies<Media>& strategies, const LightVertices& lights,
           const BidirectionalSettings& settings, core::WalkContext& context)
        : strategies_(strategies), lights_(lights), settings_(settings), context_(context) {}

    /// Merges at the last vertex of the eye path and along its last edge: found(Contribution).
    template <typename Found>
    void after_step(const SubpathWalk<Media>& walk, bool continues, const Found& found) {
        if constexpr (Media)
            for (const SubpathSegment& segment : walk.segments()) along(walk, segment, continues, found);
        const Subpath& eye = strategies_.eye_path();
        if (!continues || eye.vertices.back().infinite) return;
        if (eye.vertices.back().scattering.connectable()) at_vertex(eye, found);
    }

  private:
    template <typename Found>
    void at_vertex(const Subpath& eye, const Found& found) {
        const PathVertex& z = eye.vertices.back();
        const bool surface = z.scattering.on_surface();
        const Merge technique = surface ? Merge::surface : Merge::point_point_3d;
        if (!settings_.merging.uses(technique)) return;
        const MergeVertex at{surface, true, z.sigma_t};
        const double kernel = merge_kernel(technique, at, settings_.merging);
        lights_.for_each_near(surface, z.scattering.position,
                              settings_.merging.radius[std::size_t(technique)], near_,
                              [&](const LightVertex& v) {
                                  const PathVertex& y = lights_.vertex(v);
                                  if (surface ? !same_side(y, z) : y.scattering.phase != z.scattering.phase)
                                      return;
                                  const core::Rgb once = surface ? core::Rgb(1.0f) : spared_albedo(z);
                                  add(v, z, eye.size() - 1, kernel, once, found);
                              });
    }
    template <typename Found>
    void along(const SubpathWalk<Media>& walk, const SubpathSegment& segment, bool continues,
               const Found& found) {
        const Subpath& eye = strategies_.eye_path();
        const std::size_t j = eye.size() - (continues ? 1 : 0);
        const double connection = j == 1 ? strategies_.lens_connection() : 1.0;
        core::TransmittanceAlong along(segment.ray, segment.state, segment.boundaries, context_.rng,
                                       context_.tracking);
        lights_.for_each_along(segment.ray, on_beam_, [&](const LightVertex& v, float t) {
            const PathVertex& y = lights_.vertex(v);
            const core::Rgb tau = along.advance_to(t);
            const core::Medium* medium = along.state().current();
            if (core::is_black(tau) || !medium || &medium->phase() != y.scattering.phase) return;
            PathVertex z = walk.vertex_beside(segment, t, y, connection);
            const double kernel =
                merge_kernel(Merge::point_beam_2d, {false, true, z.sigma_t, 1.0, z.edge}, settings_.merging);
            z.weight *= tau;
            add(v, z, j, kernel, core::Rgb(float(1.0 / z.edge)), found);
        });
    }

    template <typename Found>
    void add(const LightVertex& v, const PathVertex& z, std::size_t j, double kernel, const core::Rgb& factor,
             const Found& found) {
        const PathVertex& y = lights_.vertex(v);
        const std::size_t i = v.index;
        const Transport layer = Strategies<Media>::layer_of(i, z);
        if (!strategies_.allowed(i, j + 1) || !settings_.limits.wanted[layer]) return;
        const core::Rgb f = scattered(y, z);
        if (core::is_black(f)) return;
        const double over = weight_over_kernel(lights_.path(v), i, strategies_.eye_path(), j, z, kernel);
        Contribution c;
        c.light = y.weight * z.weight * f * factor * float(over);
        c.layer = layer, c.weight = float(over * kernel);
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
    double weight_over_kernel(const Subpath& light, std::size_t i, const Subpath& eye, std::size_t j,
                              const PathVertex& z, double kernel) const {
        const PathVertex& y = light.vertices[i];
        MergedVertex m;
        m.from_light = y.density, m.from_eye = z.density;
        m.connection_light = light.technique(i, y, true), m.connection_eye = eye.technique(j, z, true);
        const double before_y =
            density_of_previous(y, light.vertices[i - 1], z.scattering.wo, core::TransportMode::power, false);
        const double before_z = density_of_previous(z, eye.vertices[j - 1], y.scattering.wo,
                                                    core::TransportMode::radiance, false);
        m.before_light = light.through(i - 1, before_y, y.others, y.edge);
        m.before_eye = eye.through(j - 1, before_z, z.others, z.edge);
        m.merges = eye.merges(z, 1.0);
        return merge_weight_over_kernel(settings_.heuristic, m, kernel);
    }

    const Strategies<Media>& strategies_;
    const LightVertices& lights_;
    const BidirectionalSettings& settings_;
    core::WalkContext& context_;
    std::vector<core::KdTree::Neighbour> near_;
    std::vector<core::RayFacingDiscs::Hit> on_beam_;
};

}  // namespace mote::integrators
