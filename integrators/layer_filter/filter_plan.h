// How a film is denoised by OpenImageDenoise: the more work its passes took, the more time it is worth.
//
// Work is counted, in closest hits a pixel, so that none of this depends on the machine.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/film/film.h"
#include "screenspace/layer_filter/layer_filter.h"

namespace mote::integrators {

struct ChosenLayer {
    std::size_t layer;  ///< of the film, which must keep its squares
    screenspace::LayerKind kind;
};

/// Layers that see the same features, are alike, and have passes.
struct LayersOfKind {
    screenspace::LayerKind kind;
    std::vector<std::size_t> layers;
};
std::vector<LayersOfKind> kinds_of(const core::Film& film, std::span<const ChosenLayer> layers);

struct FilterPlan {
    bool joins = false;                  ///< all layers of a kind are denoised as one
    bool full_features = true;           ///< false: of fewer eye rays and steps, with their noise
    std::vector<std::size_t> fine = {};  ///< layers that are denoised at twice the resolution
    bool is_fine(std::size_t layer) const;
};

/// `more`: passes to come, of the mean work.
FilterPlan plan_filter(const core::Film& film, std::span<const ChosenLayer> layers, std::uint32_t more = 0);

std::uint32_t passes_of(const core::Film& film, std::size_t layer);

}  // namespace mote::integrators
