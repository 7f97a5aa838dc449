// A plume of smoke as a sparse NanoVDB grid, made in code: no file is needed to measure marching.
#pragma once

#include "media/nano_grid.h"

namespace mote::benchmarks {

/// About a million active voxels of 128 x 256 x 128, in a box of 1 m x 2 m x 1 m around the origin.
std::shared_ptr<const media::VdbGrid> make_smoke_grid();

}  // namespace mote::benchmarks
