// OpenVDB files as NanoVDB grids in memory.
//
// A damaged VDB file can crash or hang OpenVDB's own reader, so files are read by a helper program
// (main_grid_reader.cpp) with limits on time and memory; this process takes over the finished NanoVDB buffer
// and checks its structure and values. OpenVDB's headers appear in that program alone, NanoVDB's in
// nano_grid.h and the few files that include it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/transform.h"
#include "core/objects/memory_budget.h"
#include "media/majorant_grid.h"

namespace mote::media {

struct VdbLoadOptions {
    bool clamp_negative = false;     ///< raise negative values to 0 (counted) instead of refusing them
    double time_limit = 120.0;       ///< wall-clock seconds for the helper, and one more per 10 MB
    std::uint64_t memory_limit = 0;  ///< bytes for the helper; 0: 2 GB plus 64 times the file's size
    core::MemoryBudget memory = {};  ///< of the grid, and of the helper while it reads
};

/// One grid of a file, for `mote info`.
struct VdbGridInfo {
    std::string name;
    std::string type;        ///< OpenVDB's name of the value and tree type: "Tree_float_5_4_3"
    std::string grid_class;  ///< "fog volume", "level set", "staggered", "unknown"
    std::uint64_t active_voxels = 0;
    glm::ivec3 lower{0},
        upper{0};  ///< bounding box of the active voxels, inclusive; (0, 0, 0) if there are none
    core::Vec3d voxel_size{0.0};
    bool linear = true;  ///< false: a frustum; index_to_world is then meaningless
    core::Transform index_to_world;
    std::vector<std::string> warnings;
};

/// A fog volume in memory. Immutable, shared by everything that uses it.
class VdbGrid {
  public:
    struct Data;
    explicit VdbGrid(std::unique_ptr<Data> data);
    ~VdbGrid();

    const std::string& name() const;
    const core::Transform& index_to_world() const;
    float background() const;
    float max_value() const;  ///< over every voxel, tile and the background
    /// Box of the voxels whose value differs from the background, inclusive; meaningless when uniform().
    const Voxel& lower() const;
    const Voxel& upper() const;
    bool uniform() const;  ///< no voxel differs from the background
    bool empty() const { return max_value() == 0.0f; }
    std::uint64_t active_voxels() const;
    std::uint64_t bytes() const;
    std::uint64_t clamped_voxels() const;  ///< negative values raised to 0
    /// Warnings for the user: several grids of that name, clamped values, odd metadata.
    const std::vector<std::string>& warnings() const;

    const Data& data() const { return *data_; }

  private:
    std::unique_ptr<Data> data_;
};

/// Reads one grid. Throws InputError (one line that names the file) when the file cannot be read, is damaged,
/// takes too long or too much memory, has no grid of that name (those present are listed), or when the grid
/// is not a fog volume of numbers under a regular linear transform, or holds NaN, infinite or negative
/// values. Of several grids with one name the first is taken, with a warning; "density[1]" names the second.
std::shared_ptr<const VdbGrid> load_vdb_grid(const std::string& path,
                                             const std::string& grid_name = "density",
                                             const VdbLoadOptions& options = {});

/// The least that load_vdb_grid() returns [B], by the file's metadata; of a file below `small` bytes its
/// size. Throws InputError.
double vdb_grid_memory(const std::string& path, const std::string& grid_name, double small = 16e6);

/// Every grid of a file. Throws InputError as above.
std::vector<VdbGridInfo> list_vdb_grids(const std::string& path, const VdbLoadOptions& options = {});

/// Trilinear values at positions in index space (voxel centres at integers): the very lookup that tracking
/// uses, with one cached accessor for the whole span. For benchmarks and tools.
void lookup_density(const VdbGrid& grid, std::span<const core::Vec3d> index_positions,
                    std::span<float> values);

}  // namespace mote::media
