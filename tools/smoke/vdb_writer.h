// Writes a dense grid as an OpenVDB fog volume. The only file of the tool that includes OpenVDB.
#pragma once

#include <string>

#include "tools/smoke/dense_grid.h"

namespace mote::tools {

struct VdbSummary {
    std::size_t active_voxels = 0;
    std::size_t bytes = 0;  ///< of the file
};

/// Writes grid "density" (float, stored as half, compressed). The box stands on the ground plane y = 0, with
/// x and z centred on the origin; `cell` is the edge of a voxel in metres. Densities below `cut_off` become
/// vacuum. The same values give the same bytes. Written beside the final name and renamed. Throws
/// core::InputError when the file cannot be written.
VdbSummary write_vdb(const std::string& path, const GridSize& size, const std::vector<float>& density,
                     float cell, float cut_off);

}  // namespace mote::tools
