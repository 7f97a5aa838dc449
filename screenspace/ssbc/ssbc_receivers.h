// Pixels that light is gathered at, in an order that keeps neighbours together.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "screenspace/ssbc/ssbc_patches.h"
#include "screenspace/ssbc/ssbc_residual.h"

namespace mote::screenspace {

/// All cells of a grid for which `wanted(x, y)` holds, as y * width + x, along a Z-curve: any
/// run of 16 in a dense part of it is a square.
std::vector<std::uint32_t> cells_along_z_curve(int width, int height,
                                               const std::function<bool(int, int)>& wanted);

/// The centres of the patches of pixels that take part, as receivers. A patch that an edge cuts has its
/// centre farther from the edge than the pixel may have: light is gathered for the patch, not for a point
/// that all but touches the other wall.
std::vector<SsbcReceiver> receivers_at(std::span<const PixelPatch> patches,
                                       std::span<const std::uint32_t> pixels);

}  // namespace mote::screenspace
