// Effective densities of the techniques that merge a light subpath with an eye subpath (Křivánek et al. 2014,
// "Unifying points, beams, and paths in volumetric light transport simulation").
//
// A merge at x_k needs both subpaths to find x_k. With the densities of integrators/bidirectional/subpath.h,
//   a(x_k) = p_w C / d^2 tau from the light and b(x_k) from the camera, both without sigma_t [1/m^2],
// and the factor sigma_t(x_k) that every technique's density has once left out, the density of a merge is
//   (product of the light's densities up to a(x_k)) (product of the camera's from b(x_k) on) K.
// Derived from the joint density of the two random points, times the measure of the kernel, times the number
// of light subpaths n, over sigma_t:
//   surface photon        a b n pi r^2                                      K = n pi r^2
//   point-point 3D        (a sigma_t) (b sigma_t) n (4/3) pi r^3 / sigma_t  K = n (4/3) pi r^3 sigma_t
//   photon, query beam 2D (a sigma_t) (b / tau') n pi r^2 / sigma_t         K = n pi r^2 / tau'
//   beam, beam 1D         (a / tau') (b / tau') n 2 r sin / sigma_t         K = n 2 r sin / (sigma_t tau'
//   tau')
// Where merges are found with probability q (`effort`), q n replaces n. A point on a beam costs no density
// of its distance. tau' = tau of that edge for long beams, which reach the next surface; 1 for short ones,
// which are as long as the sampled distance: the point is then reached with probability tau.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/math/random.h"
#include "core/math/vec.h"
#include "integrators/bidirectional/heuristic.h"

namespace mote::integrators {

/// Techniques that merge subpaths; index of `MergeSettings::radius`.
enum class Merge : std::uint8_t { surface, point_point_3d, point_beam_2d, beam_beam_1d };
inline constexpr std::size_t merge_count = 4;

/// One number for each technique: index Merge, or `by_connection`.
inline constexpr std::size_t by_connection = merge_count, technique_count = merge_count + 1;
using PerTechnique = std::array<double, technique_count>;
inline constexpr PerTechnique full_efforts{1.0, 1.0, 1.0, 1.0, 1.0};

enum class BeamLength : std::uint8_t {
    short_beam,  ///< up to the sampled collision
    long_beam    ///< up to the next surface
};

struct MergeSettings {
    std::array<double, merge_count> radius{};  ///< [m]; 0: the technique is not used
    /// n of a pass; each may merge with every eye subpath.
    std::array<double, merge_count> light_subpaths{1.0, 1.0, 1.0, 1.0};
    /// Probability with which a technique finds a path that is there (integrators/upbp/efforts.h).
    PerTechnique effort = full_efforts;
    bool always_sought = false;  ///< whatever the effort, which is in the weights alone: for trials
    BeamLength light_beams = BeamLength::short_beam, eye_beams = BeamLength::long_beam;

    /// True with the probability sqrt(effort): once for a light vertex or beam, which then may merge, and
    /// once for a query at a vertex or along a beam of the eye. Below 1 it takes a random number.
    bool sampled(Merge technique, core::Rng& rng) const {
        return with_chance(std::sqrt(effort[std::size_t(technique)]), rng);
    }
    /// True with the probability of all connections of an eye vertex.
    bool connections_sampled(core::Rng& rng) const { return with_chance(effort[by_connection], rng); }
    bool uses(Merge technique) const { return radius[std::size_t(technique)] > 0.0; }
    bool any() const {
        return std::any_of(radius.begin(), radius.end(), [](double r) { return r > 0.0; });
    }

  private:
    bool with_chance(double chance, core::Rng& rng) const {
        return always_sought || !(chance < 1.0) || rng.next_float() < float(chance);
    }
};

/// A vertex at which subpaths may merge.
struct MergeVertex {
    bool on_surface = false;
    bool connectable = true;  ///< false: a delta part alone, where no technique merges
    double sigma_t = 0.0;     ///< mean over channels [1/m], in media
    double tau_light = 1.0;   ///< of the edge from the light, mean over channels
    double tau_eye = 1.0;     ///< of the edge from the camera
    double sine = 1.0;        ///< of the angle between these edges
};

/// 1 over the density that a beam of this length spares at a point of its edge, with tau up to there, never
/// below e^-40 (edge_transmittance()).
inline double spared_density(BeamLength length, double tau) {
    return length == BeamLength::long_beam ? 1.0 / tau : 1.0;
}
/// Sine of the angle between two unit directions.
inline double sine_between(const core::Vec3& a, const core::Vec3& b) {
    const core::Vec3d c = glm::cross(core::Vec3d(a), core::Vec3d(b));
    return std::min(1.0, std::sqrt(glm::dot(c, c)));
}

/// K of a technique at the vertex [m^2]; 0 where it cannot merge there.
double merge_kernel(Merge technique, const MergeVertex& vertex, const MergeSettings& settings);

/// Sum of h(K) over all techniques.
double merge_terms(const MergeVertex& vertex, const MergeSettings& settings, Heuristic heuristic);

}  // namespace mote::integrators
