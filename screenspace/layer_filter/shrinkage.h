// A layer taken apart into details and put together again from what noise does not explain: Eq. (1) and (2)
// of layer_filter.h.
#pragma once

#include <array>
#include <vector>

#include "screenspace/layer_filter/filter_planes.h"

namespace mote::screenspace {

/// Three colours, and random numbers with the variance of the layer (mean over channels), which show what
/// noise becomes.
struct FilterChannels {
    static constexpr std::size_t colours = 3, probes = 2, count = colours + probes;
    std::array<std::vector<float>, count> planes;

    explicit FilterChannels(std::size_t pixels) {
        for (auto& plane : planes) plane.resize(pixels, 0.0f);
    }
};

/// y / m, and plus or minus the standard deviation of it at random, which depends on the pixel alone. Zero
/// where a pixel takes no part.
FilterChannels demodulated(const FilterFeatures& features, const FilterPlanes& planes,
                           const LayerToFilter& layer);

/// sum_l (g_l - 1) d_l of Eq. (1), for the colours and for the probes.
struct ShrunkDetails {
    FilterChannels change;
    /// Remaining variance that the probes miss: gains follow the noise, probes do not.
    std::vector<float> of_gains;
};
/// Throws Cancelled.
ShrunkDetails shrink_details(const FilterPlanes& planes, FilterChannels channels,
                             const LayerFilterSettings& settings, core::CancelToken cancelled);

/// Mean over 5 x 5 pixels of one surface.
std::vector<float> smoothed(const FilterPlanes& planes, const std::vector<float>& values,
                            core::CancelToken cancelled);

}  // namespace mote::screenspace
