// One integrator at work on one film, a pass at a time: for the render driver, and for comparisons in which
// several integrators take turns.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/film/control_passes.h"
#include "core/film/film.h"
#include "core/render/first_hit_features.h"
#include "core/render/integrator.h"

namespace mote::core {

/// The layers of a film for both: those of the integrator, then those of the features.
std::vector<Layer> film_layers(const Scene& scene, const Integrator& integrator,
                               std::span<const HitFeature> features);

/// Filter of a scene's film. Throws InputError for an unknown one.
std::unique_ptr<PixelFilter> film_filter(const Scene& scene);
/// Parts of the passes that show the error of the scene's film, where it is wanted.
PassSplit pass_split(const Scene& scene, const Integrator& integrator);
/// Size and sampler of a scene's film with such parts of the passes. Throws InputError for an unknown
/// sampler.
RenderOptions render_options(const Scene& scene, std::uint64_t seed, PassSplit split,
                             CancelToken cancelled = {});

class PassRunner {
  public:
    /// Calls Integrator::prepare(), which has `memory`. `film` has the size of the scene's film and the
    /// layers of film_layers(); it may hold the first passes already, and `controls` the first control
    /// passes, which follow those of parts that have them. Scene and film must outlive the runner. Throws
    /// InputError for an unknown filter or sampler, and Cancelled.
    PassRunner(const Scene& scene, const Integrator& integrator, std::uint64_t seed, Film& film,
               std::vector<HitFeature> features = {}, CancelToken cancelled = {},
               const MemoryBudget& memory = {}, ControlPasses controls = {});

    /// Adds the film's next pass, of the part that the estimator wants. Returns false, with the film
    /// unchanged, when it was cancelled.
    bool run_pass(const std::atomic<bool>& cancelled);
    /// After a cancelled pass, to an empty film: adds the pixels that were finished, as a pass that is zero
    /// elsewhere, and says which they are. Empty, with the film unchanged, where there are none, or features
    /// besides.
    std::vector<std::uint8_t> add_part();
    /// The pass that was added last: the layers of last_part().
    const PassImage& last_pass() const { return images_[part_]; }
    std::size_t last_part() const { return part_; }
    const ControlPasses& controls() const { return controls_; }
    /// Chooses the pixels of control passes, where there are to be any, of the film, which
    /// Estimator::finish() has worked on. Does nothing where they are chosen.
    void choose_controls();
    Estimator& estimator() { return *estimator_; }
    void add_statistics(Statistics& statistics) const;       ///< of the estimator and of the features
    double build_seconds() const { return build_seconds_; }  ///< wall time of prepare()

  private:
    double counted_work() const;  ///< so far
    bool fill(const PassContext& context, PassImage& image);
    bool fill_control(PassContext context);

    Film& film_;
    ControlPasses controls_;
    PassImage control_{1, 1, 1};  ///< of the last control pass
    std::uint64_t seed_;
    std::unique_ptr<PixelFilter> filter_;
    double build_seconds_ = 0.0;
    std::unique_ptr<Estimator> estimator_;
    std::vector<PassImage> images_;         ///< one a part
    std::size_t part_ = 0;                  ///< that has had the last pass
    std::optional<FirstHitPass> features_;  ///< in the passes of part 0
};

}  // namespace mote::core
