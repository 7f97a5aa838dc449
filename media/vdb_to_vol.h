// A VDB grid as the dense .vol grid that has the same values everywhere, for renderers that read no VDB.
#pragma once

#include "media/vol_file.h"

namespace mote::media {

class VdbGrid;

/// The voxels that differ from the background, and one voxel of background around them, which makes the
/// clamped border of a .vol equal the world outside of a VDB. The bounds are in the grid's index space, half
/// a voxel beyond the outermost voxel centres, so that `use_grid_bbox` and the grid's index_to_world put it
/// in place, turned and stretched as it may be. A uniform grid becomes one voxel around index 0. Throws
/// InputError, naming the size, when the file would be larger than `max_bytes`, and for grids beyond voxel
/// 4e6.
VolFile dense_twin(const VdbGrid& grid, std::uint64_t max_bytes);

}  // namespace mote::media
