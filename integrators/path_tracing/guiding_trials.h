// Comparison of kinds of paths by trial passes over the same pixels: which leaves least variance for the same
// counted work.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace mote::integrators {

/// Light of the paths of some passes of one kind, over the same pixels.
inline constexpr std::uint32_t trial_passes = 4;
using Trial = std::array<std::vector<float>, trial_passes>;

/// Sums over trials of several kinds of paths.
class GuidingTrials {
  public:
    explicit GuidingTrials(std::size_t kinds) : variances_(kinds), work_(kinds) {}

    /// One trial of every kind, all with the same paths, and the counted work of each [closest hits].
    void add(std::span<const Trial> kinds, std::span<const double> work);
    /// Relative variance times work; what leaves least is best.
    double loss(std::size_t kind) const { return variances_[kind] * work_[kind]; }
    std::size_t best() const;
    std::size_t kinds() const { return work_.size(); }

  private:
    std::vector<double> variances_, work_;
};

}  // namespace mote::integrators
