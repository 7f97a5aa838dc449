#include "integrators/path_tracing/guiding_trials.h"

#include <algorithm>

#include "core/math/vec.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::size_t neighbours = 256;  ///< neighbouring paths that share a mean

/// Variance of the passes of a pixel.
double variance_of(const Trial& trial, std::size_t pixel) {
    double sum = 0.0, squares = 0.0;
    for (const auto& t : trial) sum += double(t[pixel]), squares += sqr(t[pixel]);
    return std::max(0.0, squares - sum * sum / trial_passes) / (trial_passes - 1.0);
}

/// Mean of all kinds, over the paths from `first` to before `end`.
double mean_of(std::span<const Trial> kinds, std::size_t first, std::size_t end) {
    double sum = 0.0;
    for (const Trial& trial : kinds)
        for (const auto& t : trial)
            for (std::size_t i = first; i < end; ++i) sum += double(t[i]);
    return sum / (trial_passes * double(kinds.size() * (end - first)));
}

}  // namespace

/// Variances count over the squared mean around each path. That is taken from a run of neighbouring paths:
/// from those of a pixel alone, a bright one would hide itself.
void GuidingTrials::add(std::span<const Trial> kinds, std::span<const double> work) {
    const std::size_t paths = kinds.front().front().size();
    const double whole = mean_of(kinds, 0, paths);
    for (std::size_t first = 0; first < paths; first += neighbours) {
        const std::size_t end = std::min(first + neighbours, paths);
        const double mean = mean_of(kinds, first, end);
        if (!(mean > 0.0)) continue;
        for (std::size_t k = 0; k < kinds.size(); ++k)
            for (std::size_t i = first; i < end; ++i)
                variances_[k] += variance_of(kinds[k], i) / (mean * mean + 0.01 * whole * whole);
    }
    for (std::size_t k = 0; k < kinds.size(); ++k) work_[k] += work[k];
}

std::size_t GuidingTrials::best() const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < kinds(); ++k)
        if (loss(k) < loss(best)) best = k;
    return best;
}

}  // namespace mote::integrators
