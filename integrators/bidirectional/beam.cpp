#include "integrators/bidirectional/beam.h"

#include <algorithm>

#include "core/scene/media_along.h"

namespace mote::integrators {

using namespace core;

bool short_beams_possible(const RayQueries& scene) {
    return std::all_of(scene.media().begin(), scene.media().end(), [](const auto& medium) {
        const MediumTraits traits = medium->traits();
        return traits.scattering && (traits.homogeneous || !traits.chromatic);
    });
}

BeamWeight::BeamWeight(const Beam& beam, BeamLength length, WalkContext& context)
    : beam_(beam),
      length_(length),
      along_(beam.ray, beam.state, beam.boundaries, context.rng, context.tracking),
      state_(beam.state),
      boundaries_(beam.boundaries),
      counters_(context.tracking),
      throughput_(beam.weights.throughput),
      unidirectional_(beam.weights.unidirectional),
      t_(beam.ray.t_min) {}

Rgb BeamWeight::advance_to(float t) {
    if (length_ == BeamLength::short_beam) return short_advance_to(t);
    return throughput_ / average(unidirectional_) * along_.advance_to(t);
}

/// exp(-depth) in every channel, over the hero's: of the densities that the path came so far in each, and of
/// its throughput. A common factor cancels: the largest is 1.
void BeamWeight::pass(float t) {
    const Medium* medium = state_.current();
    if (medium && t_ < t) {
        // In closed form; of grids, which are grey here, one lookup does.
        const Vec3d depth =
            medium->optical_depth_along({beam_.ray.origin, beam_.ray.direction, t_, t}, 1e9f, counters_);
        const double least = std::min({depth.x, depth.y, depth.z});
        Rgb ratio(1.0f);
        for (int c = 0; c < 3; ++c)
            if (depth[c] > least) ratio[c] = float(std::exp(least - depth[c]));
        throughput_ *= ratio, unidirectional_ *= ratio;
    }
    t_ = std::fmax(t_, t);
}

Rgb BeamWeight::short_advance_to(float t) {
    if (t > beam_.reached) return Rgb(0.0f);
    while (!boundaries_.empty() && boundaries_.front().t <= t) {
        const SurfaceHit& boundary = boundaries_.front();
        pass(boundary.t);
        if (is_pane(boundary)) throughput_ *= passage_through(boundary, beam_.ray.direction).weight;
        state_.cross(*boundary.shape, boundary.geometric_normal, beam_.ray.direction);
        boundaries_ = boundaries_.subspan(1);
    }
    pass(t);
    return throughput_ / average(unidirectional_);
}

void start_on_beam(const Beam& beam, PathVertex& vertex) {
    vertex.scattering.wo = -beam.ray.direction;
    vertex.others = beam.others;
    vertex.scatterings = beam.scatterings, vertex.surface_first = beam.surface_first;
}

void move_on_beam(const RayQueries& scene, const Subpath& path, const Beam& beam, float t,
                  TrackingCounters& counters, PathVertex& vertex) {
    const PathVertex& previous = path.vertices[beam.index - 1];
    vertex.scattering.position = beam.ray.at(t);
    vertex.distance_squared = 1.0;
    if (!(beam.parallel || previous.infinite)) {
        const Vec3d d = Vec3d(vertex.scattering.position) - Vec3d(previous.scattering.position);
        vertex.distance_squared = std::max(glm::dot(d, d), 1e-40);
    }
    Ray edge = beam.ray;
    edge.t_max = t;
    vertex.edge = edge_transmittance(scene, edge, beam.state, counters);
    vertex.density =
        beam.density * vertex.area_measure(beam.ray.direction, vertex.distance_squared) * vertex.edge;
}

void set_merges(const Subpath& path, const MediumCoefficients& at, PathVertex& vertex) {
    vertex.sigma_t = double(average(at.sigma_t)), vertex.sigma_s = at.sigma_s;
    const MergeVertex v{vertex.scattering.on_surface(), vertex.scattering.connectable(), vertex.sigma_t};
    const auto term = [&](Merge technique) {
        return mis_term(path.heuristic, merge_kernel(technique, v, path.merging));
    };
    vertex.point_merges = term(Merge::surface) + term(Merge::point_point_3d);
    vertex.point_beam_merges = term(Merge::point_beam_2d);
    vertex.beam_beam_merges = term(Merge::beam_beam_1d);
}

}  // namespace mote::integrators
