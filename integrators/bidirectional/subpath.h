// A subpath of bidirectional path tracing, from the camera or from a light, and what every vertex holds so
// that a path of two joined subpaths has its MIS weight in constant time.
//
// A path of n vertices x_0 (light) ... x_{n-1} (camera) can be found by techniques (s, t): s vertices from
// the light, t from the camera, and a connection between them (s = 0: the eye path hits the light; s = 1: a
// light is sampled for the receiver; t = 1: the light path is joined to the lens). The heuristics (Veach
// 1997, Sec. 10.2) give technique (s, t) the weight h(p_s) / sum_i h(p_i), h(p) = p^2 or p. Neighbouring
// densities differ in one vertex,
//   p_{i-1} / p_i = (density of x_{i-1} from the camera) / (density of x_{i-1} from the light),
// so the sum over all techniques with fewer vertices from one end is a Horner scheme along that end's
// subpath. All but the last two of its terms are known when a vertex is made (`others`).
//
// **In media weights need no true density of a random walk**, only the same function of the path in every
// technique. A density here is
//   p_w(w) C(x) / d^2 tau(edge)      [1/m^2; a collision has C = 1 and leaves its sigma_t out]
// with tau from the optical depth of the edge by marching: the same from both ends, never an estimate. What
// is left out (sigma_t, roulette, panes that let a path pass by chance) is alike in all techniques.
//
// Where subpaths are also merged (`merging`), every sum holds those techniques as well (merged_weights.h).
#pragma once

#include <vector>

#include "core/scene/reverse_density.h"
#include "integrators/bidirectional/merge_kernels.h"
#include "integrators/bidirectional/merged_weights.h"

namespace mote::integrators {

struct PathVertex {
    /// On the lens or on a light (index 0) only the position counts.
    core::ScatteringVertex scattering;
    core::MediumState state;  ///< media on the side of scattering.wo
    core::Rgb weight{0.0f};   ///< light (or importance) that arrives, over its density
    /// Density of the vertex, sampled from the one before it, per area; of a light at infinity per solid
    /// angle. 1 at the lens.
    double density = 1.0;
    double edge = 1.0;              ///< tau of the edge to the vertex before it
    double distance_squared = 1.0;  ///< of that edge [m^2]; 1 where there is none: a light at infinity
    /// h of what the density of the technique that connects along this edge has beyond those of the vertices.
    double connection = 1.0;
    double others = 0.0;    ///< sum over the techniques with at least two vertices less from this end
    bool delta = false;     ///< the path continued by a delta part
    bool infinite = false;  ///< a light at infinity: the start of a light path, the end of an eye path
    bool start = false;     ///< on a light, with its normal there, or zero
    core::Vec3 light_normal{0.0f};
    double sigma_here = 0.0;    ///< mean over channels [1/m], of the medium on the side of scattering.wo
    core::Rgb sigma_s{0.0f};    ///< [1/m], in media where subpaths are merged
    double sigma_t = 0.0;       ///< mean over channels [1/m], likewise
    double point_merges = 0.0;  ///< sum of h(K) of the merges of two points
    /// h(K) of the merges of a point with a beam and of two beams, with a sine and tau of 1.
    double point_beam_merges = 0.0, beam_beam_merges = 0.0;
    int scatterings = 0;  ///< of an eye path before this vertex, without leading mirrors and glass
    bool surface_first = true;

    /// C(x) / d^2 of a vertex seen along a unit direction from the square root of `d2` away; 1 at infinity.
    double area_measure(const core::Vec3& direction, double d2) const {
        if (infinite) return 1.0;
        if (!start) return double(scattering.geometric_cosine(direction)) / d2;
        if (light_normal == core::Vec3(0.0f)) return 1.0 / d2;
        return std::fabs(double(glm::dot(light_normal, direction))) / d2;
    }
};

struct Subpath {
    std::vector<PathVertex> vertices;
    Heuristic heuristic = Heuristic::power;
    /// h of the technique that takes no vertex from this end: of a light, 1 if it can be hit.
    double without = 0.0;
    bool from_light = false;
    bool connects = true;   ///< false: subpaths are merged only
    MergeSettings merging;  ///< none by default

    std::size_t size() const { return vertices.size(); }
    /// PathVertex::connection of an edge between vertices that were both sampled by scattering.
    double connection_term() const { return mis_term(heuristic, merging.effort[by_connection]); }

    /// h, in terms of the vertices' densities, of the technique that connects along the edge to vertex k: 0
    /// where a delta part stands at one of its ends. `last`: k is where the path is connected.
    double technique(std::size_t k, bool last = false) const { return technique(k, vertices[k], last); }
    double technique(std::size_t k, const PathVertex& vertex, bool last) const {
        if (!connects) return 0.0;
        if (k == 0) return without;
        if ((k >= 2 && vertices[k - 1].delta) || (!last && vertex.delta)) return 0.0;
        return vertex.connection;
    }
    /// Sum of h(K) of the merges at a vertex; of the edge after it tau and direction, either way.
    double merges(const PathVertex& vertex, double next_edge, const core::Vec3& next_direction) const {
        double beams = vertex.point_beam_merges;
        if (vertex.beam_beam_merges > 0.0) {
            const double tau = from_light ? vertex.edge : next_edge;
            beams += vertex.beam_beam_merges *
                     mis_term(heuristic, sine_between(vertex.scattering.wo, next_direction) *
                                             spared_density(merging.light_beams, tau));
        }
        if (!(beams > 0.0)) return vertex.point_merges;
        const double to_eye = from_light ? next_edge : vertex.edge;
        return vertex.point_merges + beams * mis_term(heuristic, spared_density(merging.eye_beams, to_eye));
    }
    /// Sum over all techniques with fewer vertices from this end, in terms of the one that connects vertex k.
    /// `reverse`, `reverse_before`: densities of vertices k and k - 1 sampled from the other end; of the
    /// connection tau, which `reverse` holds, and the direction, either way.
    double others(std::size_t k, double reverse, double reverse_before, double tau,
                  const core::Vec3& direction) const {
        const PathVertex& v = vertices[k];
        const double before = k == 0 ? 0.0 : through(k - 1, reverse_before, v);
        return techniques_before(heuristic,
                                 {v.density, reverse, technique(k, true), merges(v, tau, direction)}, before);
    }
    /// Terms of it that do not depend on how the path continues, once vertex k is made.
    double others_before(std::size_t k, double reverse_of_second_before) const {
        if (k < 2) return 0.0;
        return through(k - 2, reverse_of_second_before, vertices[k - 1]);
    }
    /// Eq. (1) of merged_weights.h at vertex k, where the path continued to `next`, which has the sum up to
    /// vertex k - 1.
    double through(std::size_t k, double reverse, const PathVertex& next) const {
        const PathVertex& v = vertices[k];
        return techniques_before(
            heuristic,
            {v.density, reverse, technique(k), v.delta ? 0.0 : merges(v, next.edge, next.scattering.wo)},
            next.others);
    }
};

/// Density of the vertex before k, sampled from the other end by a path that comes to vertex k from the
/// direction `from`. `mode` is that of the subpath itself; `delta`: k is passed by a delta part, whose own
/// density is left out at both ends.
double density_of_previous(const Subpath& path, std::size_t k, const core::Vec3& from,
                           core::TransportMode mode, bool delta);
/// Likewise, of `previous`, from a vertex that need not be part of the subpath.
double density_of_previous(const PathVertex& vertex, const PathVertex& previous, const core::Vec3& from,
                           core::TransportMode mode, bool delta);

/// tau of the segment for weights: exp(-optical depth), marched in steps of 16 voxels, mean over channels.
/// `state` holds the media at ray.t_min. Not below e^-40, nor where the
/// depth is infinite: weights may be any function of the path.
double edge_transmittance(const core::RayQueries& scene, const core::Ray& ray, const core::MediumState& state,
                          core::TrackingCounters& counters);

/// The segment between two vertices, off the surfaces at its ends: the same from both.
core::Ray segment_between(const core::ScatteringVertex& a, const core::ScatteringVertex& b,
                          const core::Vec3& direction);

}  // namespace mote::integrators
