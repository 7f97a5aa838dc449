// Features and modulation of one layer as planes of floats, for loops over a row.
#pragma once

#include <vector>

#include "screenspace/layer_filter/layer_filter.h"

namespace mote::screenspace {

struct FilterPlanes {
    int width, height;
    LayerKind kind;
    std::vector<float> px, py, pz, nx, ny, nz, sx, sy, sz;  ///< position, normals; of surfaces alone
    std::vector<float> footprint, distance, transmittance, log_transmittance;
    /// Weight of a pixel for others, 0 where it takes no part: modulated by S, a volume layer's mean is the
    /// ratio of two means; a surface behind smoke is seen by as many paths as come through.
    std::vector<float> weight;
    std::vector<float> channels;  ///< which channels have light, as bits: others are never averaged with them
    const std::vector<PixelFrame>* frame;

    FilterPlanes(const FilterFeatures& features, const LayerToFilter& layer);
    std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width) + std::size_t(x); }
};

/// Divisor of a layer, per channel; 1 where that would be zero.
core::Rgb modulation(const FilterFeatures& features, LayerKind kind, std::size_t pixel);

}  // namespace mote::screenspace
