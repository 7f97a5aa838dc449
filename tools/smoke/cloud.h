// A cumulus cloud as a density grid: heaped balls on a flat base, broken up by fractal noise.
//
// Not a simulation: the shape is the distance to a union of balls, displaced by billowing noise, as film
// renderers model clouds (Wrenninge 2012, "Production Volume Rendering", chapters on pyroclastic noise).
#pragma once

#include <cstdint>

#include "tools/smoke/dense_grid.h"

namespace mote::tools {

struct CloudSettings {
    GridSize size{192, 112, 160};
    std::uint64_t seed = 1;
};

/// Densities in [0, 1], zero outside the cloud. The cloud fills the box but for a thin margin.
std::vector<float> make_cloud(const CloudSettings& settings);

}  // namespace mote::tools
