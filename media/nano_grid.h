// The inside of VdbGrid and the trilinear lookup that tracking uses. Includes NanoVDB: keep it out of other
// headers.
#pragma once

#include <nanovdb/NanoVDB.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "media/grid_reader_process.h"
#include "media/vdb_grid.h"

namespace mote::media {

/// Where the 8^3 values of each block of voxels are: one array instead of NanoVDB's tree. Tiles and the
/// background become blocks of equal values, shared by all of one value.
class BlockTable {
  public:
    BlockTable() = default;
    /// Over the voxels from `lower` to `upper` and what interpolation sees beyond them. Grids with far more
    /// blocks than leaves get no table.
    BlockTable(const nanovdb::FloatGrid& grid, const Voxel& lower, const Voxel& upper);

    bool empty() const { return blocks_.empty(); }
    std::uint64_t bytes() const { return blocks_.size() * sizeof(float*) + uniform_.size() * sizeof(Block); }
    const float* const* blocks() const { return blocks_.data(); }
    /// Index positions are taken relative to the first voxel, and clamped to where eight voxels are at hand;
    /// from there on outwards all is background.
    const core::Vec3d& origin() const { return origin_; }
    const core::Vec3d& last() const { return last_; }
    std::int32_t stride_x() const { return stride_x_; }
    std::int32_t stride_y() const { return stride_y_; }

  private:
    using Block = std::array<float, 512>;
    const float* uniform(float value);

    std::vector<const float*> blocks_;  ///< z fastest, as within a block
    std::map<float, Block> uniform_;
    core::Vec3d origin_{0.0}, last_{0.0};
    std::int32_t stride_x_ = 0, stride_y_ = 0;
};

struct VdbGrid::Data {
    AlignedBuffer buffer;
    const nanovdb::FloatGrid* grid = nullptr;  ///< in buffer; its structure has been checked
    std::string name;
    core::Transform index_to_world;
    float background = 0.0f, max_value = 0.0f;
    Voxel lower{0}, upper{0};
    bool uniform = true;
    std::uint64_t active_voxels = 0, clamped = 0;
    std::vector<std::string> warnings;
    BlockTable table;  ///< made by VdbGrid
};

/// Trilinear lookups: one a ray.
class NanoCursor {
  public:
    explicit NanoCursor(const VdbGrid& grid)
        : table_(grid.data().table), blocks_(table_.blocks()), grid_(*grid.data().grid) {}

    /// `p` in index space, clamped to +-1e9 (load_vdb_grid refuses grids that reach so far).
    float lookup(const core::Vec3d& p) const {
        if (!blocks_) return sparse_lookup(p);
        const core::Vec3d q = glm::min(glm::max(p - table_.origin(), core::Vec3d(0.0)), table_.last());
        const auto x = std::int32_t(q.x), y = std::int32_t(q.y), z = std::int32_t(q.z);
        const float fx = float(q.x - x), fy = float(q.y - y), fz = float(q.z - z);
        const std::int32_t block = (x >> 3) * table_.stride_x() + (y >> 3) * table_.stride_y() + (z >> 3);
        const std::int32_t voxel = (x & 7) << 6 | (y & 7) << 3 | (z & 7);
        // Within one block, which is where two thirds of all lookups fall, all eight values lie at fixed
        // offsets from the first.
        if ((x & 7) != 7 && (y & 7) != 7 && (z & 7) != 7) {
            const float* v = blocks_[block] + voxel;
            return interpolate(fx, fy, fz, v[0], v[1], v[8], v[9], v[64], v[65], v[72], v[73]);
        }
        // The step to the next voxel of an axis, in blocks and in voxels.
        const auto step = [](std::int32_t i, std::int32_t blocks, std::int32_t voxels) {
            return (i & 7) == 7 ? Step{blocks, -7 * voxels} : Step{0, voxels};
        };
        const Step sx = step(x, table_.stride_x(), 64), sy = step(y, table_.stride_y(), 8),
                   sz = step(z, 1, 1);
        const auto at = [&](std::int32_t b, std::int32_t v) { return blocks_[block + b][voxel + v]; };
        return interpolate(fx, fy, fz, at(0, 0), at(sz.block, sz.voxel), at(sy.block, sy.voxel),
                           at(sy.block + sz.block, sy.voxel + sz.voxel), at(sx.block, sx.voxel),
                           at(sx.block + sz.block, sx.voxel + sz.voxel),
                           at(sx.block + sy.block, sx.voxel + sy.voxel),
                           at(sx.block + sy.block + sz.block, sx.voxel + sy.voxel + sz.voxel));
    }

  private:
    struct Step {
        std::int32_t block, voxel;
    };
    static float mix(float a, float b, float t) { return a + t * (b - a); }
    static float interpolate(float fx, float fy, float fz, float v000, float v001, float v010, float v011,
                             float v100, float v101, float v110, float v111) {
        const float y0 = mix(mix(v000, v001, fz), mix(v010, v011, fz), fy);
        const float y1 = mix(mix(v100, v101, fz), mix(v110, v111, fz), fy);
        return mix(y0, y1, fx);
    }
    float sparse_lookup(const core::Vec3d& p) const;

    const BlockTable& table_;
    const float* const* blocks_;  ///< null: no table
    const nanovdb::FloatGrid& grid_;
};

/// The grid that TrackedMedium wants (see there).
struct NanoGrid {
    using Value = float;
    NanoCursor cursor() const { return NanoCursor(*grid); }

    std::shared_ptr<const VdbGrid> grid;
    core::Transform world_to_index;
    MajorantGrid<float> majorants;
    std::string description;
};

/// Calls at_leaf(origin, const float* 512 values) and at_tile(origin, edge in voxels, value) for everything
/// below the root, with origins derived from the tree's structure.
template <typename AtLeaf, typename AtTile>
void for_each_node(const nanovdb::FloatGrid& grid, AtLeaf&& at_leaf, AtTile&& at_tile) {
    const auto visit = [&](const auto& self, const auto& node, const Voxel& origin) -> void {
        using Node = std::decay_t<decltype(node)>;
        if constexpr (Node::LEVEL == 0) {
            at_leaf(origin, node.data()->mValues);
        } else {
            constexpr std::uint32_t log2dim = Node::LOG2DIM, mask = (1u << log2dim) - 1;
            constexpr std::int64_t edge = Node::ChildNodeType::DIM;
            const auto* data = node.data();
            for (std::uint32_t n = 0; n < (1u << (3 * log2dim)); ++n) {
                const Voxel at = origin + edge * Voxel(n >> (2 * log2dim), (n >> log2dim) & mask, n & mask);
                if (data->mChildMask.isOn(n))
                    self(self, *data->getChild(n), at);
                else
                    at_tile(at, edge, data->mTable[n].value);
            }
        }
    };
    const auto* root = grid.tree().root().data();
    for (std::uint32_t i = 0; i < root->mTableSize; ++i) {
        const auto* tile = root->tile(i);
        const auto key = tile->origin();
        const Voxel origin(key[0], key[1], key[2]);
        if (tile->isChild())
            visit(visit, *root->getChild(tile), origin);
        else
            at_tile(origin, std::int64_t(nanovdb::NanoUpper<float>::DIM), tile->value);
    }
}

/// Majorants over the voxels that differ from the background; outside, the background.
MajorantGrid<float> nano_majorants(const VdbGrid& grid);

/// Throws InputError unless the buffer is a NanoVDB float grid all of whose nodes lie inside it.
const nanovdb::FloatGrid* checked_nano_grid(const AlignedBuffer& buffer, const std::string& path);

}  // namespace mote::media
