// A quick image of a density grid: what is seen of it against a light wall, as a PNG.
#pragma once

#include <string>

#include "tools/smoke/dense_grid.h"

namespace mote::tools {

/// Writes 1 - exp(-extinction * integral of the density along z), lit from above within the grid, one pixel a
/// cell. `extinction` is per metre at density 1. Throws core::InputError when the file cannot be written.
void write_preview(const std::string& path, const GridSize& size, const std::vector<float>& density,
                   float cell, float extinction);

}  // namespace mote::tools
