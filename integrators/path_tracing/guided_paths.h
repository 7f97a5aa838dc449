// Guides of the passes of a picture: paths learn where light comes from while the picture is made.
//
// Training passes precede the picture's passes, as many as keep their counted work below a share of what the
// picture's passes before have taken; passes 1, 2, 4, ... halve what was learned before, since later
// ones are guided better. Training paths are none of the picture, and depend on scene, seed and their number
// alone: the guide of a pass is the same on any number of threads, and after a resume, or for a share of the
// passes on another machine, where it is trained again. Passes of the picture are as independent of each
// other as unguided ones.
#pragma once

#include <memory>

#include "integrators/eye_path/counters.h"
#include "integrators/path_tracing/guiding_trials.h"
#include "integrators/path_tracing/training_pass.h"

namespace mote::integrators {

/// Guide of each pass.
class PassGuides {
  public:
    virtual ~PassGuides() = default;
    /// Guide of a pass, valid until the next call; trains first. Throws Cancelled.
    virtual const lights::ScatteringGuide& guide_of(std::uint32_t pass, core::CancelToken cancelled) = 0;
    virtual void add_statistics(core::Statistics& statistics) const = 0;
};

/// Guides nothing.
class NoPassGuides final : public PassGuides {
  public:
    const lights::ScatteringGuide& guide_of(std::uint32_t, core::CancelToken) override {
        return lights::no_guide();
    }
    void add_statistics(core::Statistics&) const override {}
};

/// Trains a guide before the passes. With Guiding::automatic, trial passes decide which parts of it are used,
/// and end the training where they find that it does not pay.
template <bool Media>
class TrainedGuides final : public PassGuides {
  public:
    /// Scene, settings and counters must outlive it. `ray_work`: cost of a guided path's ray in unguided
    /// ones. `counters` receive the rays of the training. Throws OutOfMemory.
    TrainedGuides(const core::Scene& scene, const core::RenderOptions& options, const PathSettings& settings,
                  double ray_work, SharedCounters& counters);

    const lights::ScatteringGuide& guide_of(std::uint32_t pass, core::CancelToken cancelled) override;
    void add_statistics(core::Statistics& statistics) const override;

    /// One training pass, whatever the budget.
    void train(core::CancelToken cancelled);
    const lights::LearnedGuide& learned() const { return *guide_; }  ///< so far
    int passes() const { return passes_; }                           ///< of training
    double work() const { return work_; }                            ///< of training [closest hits]
    double work_of_path() const { return paths_work_ / (double(passes_) * double(guiding_.paths)); }

  private:
    void restart();
    bool trial_follows(int passes) const;
    bool budget_allows(std::uint32_t pass) const;
    void try_out(core::CancelToken cancelled);
    double count(const SharedCounters& own);

    core::RenderOptions options_;
    const GuidingSettings& guiding_;
    TrainingPaths<Media> paths_;
    lights::GuideParts largest_;  ///< all that a guide can decide in the scene
    double ray_work_;
    SharedCounters& counters_;

    std::unique_ptr<lights::LearnedGuide> guide_;
    std::uint32_t trained_for_ = 0;  ///< pass of the picture
    int passes_ = 0;                 ///< of training
    std::uint32_t indices_ = 0;      ///< of passes of training and trials
    double work_ = 0.0;              ///< of all of them [closest hits]
    double paths_work_ = 0.0;        ///< of training paths alone, without learning
    bool guides_ = false, given_up_ = false;
    std::vector<lights::GuideParts> parts_;  ///< on trial, besides unguided paths
    GuidingTrials trials_;
    double seconds_ = 0.0;
};

/// The guides of `settings`.
template <bool Media>
std::unique_ptr<PassGuides> make_pass_guides(const core::Scene& scene, const core::RenderOptions& options,
                                             const PathSettings& settings, double ray_work,
                                             SharedCounters& counters);

}  // namespace mote::integrators
