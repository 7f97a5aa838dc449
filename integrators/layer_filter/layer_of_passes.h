// A layer of a film by its passes alone, and how certain it is.
#pragma once

#include <cstdint>
#include <vector>

#include "core/film/film.h"

namespace mote::integrators {

/// Passes that the variance of a mean is taken from.
enum class PassVariance : std::uint8_t {
    independent,  ///< as if they were
    points        ///< as points of a sequence (screenspace/denoising/local_gain.h)
};

struct LayerOfPasses {
    std::vector<core::Rgb> mean;
    std::vector<core::Rgb> variance;  ///< of the mean; infinity after fewer than `fewest` passes
};

/// Undoes Film::set_mean(): an earlier call, for a preview, may have replaced the mean. Needs the layer's
/// squares.
LayerOfPasses layer_of_passes(core::Film& film, std::size_t layer, std::uint32_t fewest, PassVariance from);

}  // namespace mote::integrators
