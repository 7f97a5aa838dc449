// Trials of guides: with which of their parts do paths leave least variance for the same work?
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "integrators/path_tracing/passes_of_paths.h"
#include "lights/guiding/learned_guide.h"

namespace mote::integrators {

template <bool Media>
class GuidingTrials {
  public:
    /// `ray_work`: cost of a guided ray in unguided ones. All must outlive it; counters receive the rays.
    GuidingTrials(const core::Scene& scene, const core::RenderOptions& options, const PathSettings& settings,
                  double ray_work, SharedCounters& counters)
        : scene_(scene), options_(options), settings_(settings), ray_work_(ray_work), counters_(counters) {}

    /// The parts, up to `largest`, with which variance times counted work is least, in passes of all kinds
    /// over the same pixels; nothing where it is more than `limit` times that without the guide. Depends on
    /// scene, seed and guide alone. Throws Cancelled.
    std::optional<lights::GuideParts> best_of(lights::LearnedGuide& guide, lights::GuideParts largest,
                                              double limit);

  private:
    static constexpr std::uint32_t passes = 4;  ///< of each kind
    struct Trial {
        std::array<std::vector<float>, passes> light;  ///< of each path, averaged over channels
        double work = 0.0;                             ///< counted

        double variance(std::size_t path) const;
    };
    static std::array<double, 2> relative_variances(const Trial& plain, const Trial& guided);
    Trial trial(const lights::ScatteringGuide& guide, double ray_work, std::uint32_t begin);
    std::vector<float> light_of(const PassOfPaths& pass, const lights::ScatteringGuide& guide,
                                SharedCounters& counters);

    const core::Scene& scene_;
    const core::RenderOptions& options_;
    const PathSettings& settings_;
    double ray_work_;
    SharedCounters& counters_;
    std::optional<Trial> plain_;  ///< once it was made
};

}  // namespace mote::integrators
