// One method with one seed in a trade: its film, its clocks, and its checkpoint.
#pragma once

#include <memory>
#include <string>

#include "core/render/checkpoint.h"
#include "core/render/pass_runner.h"
#include "trade/methods_file.h"
#include "trade/record.h"
#include "trade/reference.h"

namespace mote::trade {

struct Limits {
    std::optional<double> seconds;  ///< wall time of build and passes, per method and seed
    std::optional<std::uint32_t> passes;
};

/// Seconds of wall and processor time, and the spread of the passes' biases: all that a film does
/// not hold and that must survive an interrupt.
struct Tally {
    std::uint32_t passes = 0;
    double build_wall = 0.0, build_cpu = 0.0;
    double wall = 0.0, cpu = 0.0;  ///< passes alone
    /// Spread of the passes' biases, plus their part's contribution to the picture (Welford 1962).
    struct Spread {
        std::uint32_t passes = 0;
        double mean = 0.0, squares = 0.0;
    };
    std::vector<Spread> spreads;  ///< one for each part of the picture
    /// Standard error of the bias of the mean; NaN where a part has fewer than two passes.
    double bias_standard_error() const;
    double seconds() const { return build_wall + wall; }
};

class Contestant {
  public:
    /// Continues from the checkpoint files at `checkpoint` (a path without extension) where they are there,
    /// and calls prepare(). Throws InputError for a damaged checkpoint.
    /// `reference`, which must outlive it, judges it.
    Contestant(const core::Scene& scene, const Method& method, std::uint64_t seed, const Reference& reference,
               std::string checkpoint, const std::string& content_hash);

    const Method& method() const { return method_; }
    std::uint64_t seed() const { return seed_; }
    const Tally& tally() const { return tally_; }
    bool is_done(const Limits& limits) const;
    /// Returns false when it was cancelled; nothing has changed then.
    bool run_pass(const std::atomic<bool>& cancelled);
    /// The picture as a user would get it now: a copy of the film after Estimator::finish.
    core::Film finished(double& wall, double& cpu) const;
    /// Holds a finished picture against the reference.
    Record judge(const core::Film& picture, double finish_wall, double finish_cpu) const;
    core::Statistics statistics() const;

    /// Writes the checkpoint, unless nothing has changed since the last one.
    void save();
    void remove_checkpoint() const;

  private:
    void restore();
    void add_to_spread(const core::PassImage& image, std::size_t part);

    const Method& method_;
    const Reference& reference_;
    std::uint64_t seed_;
    std::string checkpoint_;
    core::CheckpointKey key_;
    core::Film film_;
    double floor_;  ///< of the reference
    Tally tally_, saved_;
    std::unique_ptr<core::PassRunner> runner_;
};

}  // namespace mote::trade
