// Points of a ray where light scatters towards its start: a few of them estimate the integral along all of
// it.
//
// One walk along the ray (walk_to_surface(), ray_walk.h) finds what comes through to its end and leaves any
// number of candidates on the way, each with the weight of light that is scattered there:
//   throughput T(t) sigma_s(t) / density of the candidate
// whose sum over candidates is unbiased. Of them a fixed number is sampled in proportion to their weights, by
// systematic sampling: equal steps through the sum of weights from one random start, so that points keep
// their distance. No channel drives anything: weights are those of all channels, and later decisions may be
// driven by any one that is sampled independently.
#pragma once

#include <span>
#include <vector>

#include "core/math/random.h"
#include "core/math/ray.h"
#include "core/scene/medium_state.h"

namespace mote::core {

struct ScatteringPoint {
    Vec3 position{0.0f};
    Rgb weight{0.0f};        ///< black: no point
    std::uint32_t part = 0;  ///< of the ray: ScatteringPoints::state_of()
};

class ScatteringPoints {
  public:
    /// `count` points a ray; 0: what comes through alone is wanted.
    explicit ScatteringPoints(int count) : count_(count) {}
    int count() const { return count_; }
    /// Number of candidates that a medium should submit, where it is free to choose.
    int candidates() const { return 4 * std::max(count_, 1); }

    /// Begins a ray; `rng` is sampled from where there are too many candidates to keep, and in choose().
    void start(const Rng& rng);
    /// Candidates from now on lie in the medium of `state`; distance_of() is between these.
    void begin_part(const MediumState& state, float first = 0.0f, float last = infinity);
    /// A candidate. Weights are per channel, not negative.
    void add(const Vec3& position, const Rgb& weight);

    /// count() points in random order, of which the n-th lies anywhere with a chance in proportion to the
    /// weights; none where there are no candidates. Where the sum of all weights is below `rare`, a point is
    /// left out (black) with the chance that keeps the others at the weight of a sum of `rare`.
    std::span<const ScatteringPoint> choose(float rare);
    const MediumState& state_of(const ScatteringPoint& point) const { return parts_[point.part].state; }

    /// All candidates kept so far, for a choice of another kind.
    static constexpr std::size_t max_candidates = 512;
    std::span<const ScatteringPoint> kept() const { return candidates_; }
    /// Distance of a candidate along the ray, at which a path may scatter.
    float distance_of(const ScatteringPoint& point, const Ray& ray) const;

  private:
    /// Samples `count` of `from` in order into `to`; returns the sum of the weights.
    double sample(const std::vector<ScatteringPoint>& from, std::size_t count,
                  std::vector<ScatteringPoint>& to);

    /// A part of the ray in one medium.
    struct Part {
        MediumState state;
        float first, last;  ///< [m]
    };

    int count_;
    Rng rng_;
    std::vector<Part> parts_;
    std::vector<ScatteringPoint> candidates_, chosen_;
};

}  // namespace mote::core
