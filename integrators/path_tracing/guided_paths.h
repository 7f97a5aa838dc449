// Training of guided paths: passes 1, 2, 4, ... of paths, which are themselves guided by what was learned
// before.
//
// The first passes are none of the picture: they are guided badly. Later ones are the picture's own, which a
// guide learns from after each. It depends on scene, seed and the number of the pass alone, not on threads: a
// render that is resumed or shared out traces the passes before once more. A pass is unbiased whatever
// earlier ones have taught, so that the covariance of any two is zero, and their mean is that of unguided
// ones.
//
// Trials decide how far paths are guided (Guiding::automatic): once after the first passes, where it is
// enough that it may pay later, and once when all was learned.
#pragma once

#include <memory>

#include "integrators/eye_path/counters.h"
#include "integrators/path_tracing/guiding_trials.h"
#include "integrators/path_tracing/trace_paths.h"
#include "lights/guiding/learned_guide.h"

namespace mote::integrators {

/// A guide, and what it learns from.
template <bool Media>
class GuideTraining {
  public:
    /// Traces the first training passes; counters receive their rays. `ray_work`: cost of a guided ray in
    /// unguided ones. All must outlive it. Throws Cancelled, and OutOfMemory.
    GuideTraining(const core::Scene& scene, const core::RenderOptions& options, const PathSettings& settings,
                  double ray_work, SharedCounters& counters);

    /// Null: paths are not guided.
    const lights::LearnedGuide* guide() const { return parts_ ? guide_.get() : nullptr; }
    /// All that a guide can decide in the scene: what has to be recorded.
    lights::GuideParts largest_parts() const { return largest_parts_; }
    /// Passes of the picture that it has learned from.
    std::uint32_t learned() const { return learned_; }
    /// Passes of the picture that it learns from in all.
    std::uint32_t picture_passes() const { return picture_passes_; }
    /// True where the paths of a task are recorded in a pass of the picture: as many tasks as hold
    /// GuidingSettings::paths, others in each pass.
    bool records(std::uint32_t pass, std::size_t task) const;
    /// Learns from the next pass of the picture, from its tasks in their order. Throws Cancelled.
    void learn(std::vector<lights::GuidingSamples>& tasks);
    /// Forgets the picture's passes.
    void restart();

  private:
    void train();
    void decide(const std::optional<lights::GuideParts>& parts);
    void learn_from(std::uint32_t pass, lights::GuidingSamples& samples);

    const core::Scene& scene_;
    core::RenderOptions options_;
    const PathSettings& settings_;
    SharedCounters& counters_;
    std::unique_ptr<lights::LearnedGuide> guide_;
    const lights::GuideParts largest_parts_;
    std::optional<GuidingTrials<Media>> trials_;  ///< of Guiding::automatic
    /// With which passes of the picture are traced, now and when the first of them is; nothing: unguided.
    std::optional<lights::GuideParts> parts_, first_parts_;
    std::uint32_t picture_passes_ = 0, learned_ = 0;
};

}  // namespace mote::integrators
