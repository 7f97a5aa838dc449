// The inside of VdbGrid and the trilinear lookup that tracking uses. Includes NanoVDB: keep it out of other
// headers.
#pragma once

#include <nanovdb/NanoVDB.h>

#include <memory>
#include <string>
#include <vector>

#include "media/grid_reader_process.h"
#include "media/vdb_grid.h"

namespace mote::media {

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
};

/// Trilinear lookups with a cache of the nodes visited last: one a ray.
class NanoCursor {
  public:
    explicit NanoCursor(const nanovdb::FloatGrid& grid) : accessor_(grid.tree().root()) {}

    /// `p` in index space, clamped to +-1e9 (load_vdb_grid refuses grids that reach so far).
    float lookup(const core::Vec3d& p) {
        const core::Vec3d q = glm::clamp(p, core::Vec3d(-1e9), core::Vec3d(1e9));
        const int x = floor_to_int(q.x), y = floor_to_int(q.y), z = floor_to_int(q.z);
        const float fx = float(q.x - x), fy = float(q.y - y), fz = float(q.z - z);
        // Within one leaf of 8^3 voxels, which is where two thirds of all lookups fall, all eight values lie
        // at fixed offsets from the first.
        if ((x & 7) != 7 && (y & 7) != 7 && (z & 7) != 7) {
            if (const auto* leaf = accessor_.probeLeaf({x, y, z})) {
                const float* v = leaf->data()->mValues + (((x & 7) << 6) | ((y & 7) << 3) | (z & 7));
                return interpolate(fx, fy, fz, v[0], v[1], v[8], v[9], v[64], v[65], v[72], v[73]);
            }
            return accessor_.getValue({x, y, z});  // a tile or the background: the same at all eight corners
        }
        return across_leaves(x, y, z, fx, fy, fz);
    }

  private:
    static int floor_to_int(double v) {
        const int i = int(v);
        return i - int(v < double(i));
    }
    static float mix(float a, float b, float t) { return a + t * (b - a); }
    static float interpolate(float fx, float fy, float fz, float v000, float v001, float v010, float v011,
                             float v100, float v101, float v110, float v111) {
        const float y0 = mix(mix(v000, v001, fz), mix(v010, v011, fz), fy);
        const float y1 = mix(mix(v100, v101, fz), mix(v110, v111, fz), fy);
        return mix(y0, y1, fx);
    }
    float across_leaves(int x, int y, int z, float fx, float fy, float fz) {
        float v[2][2][2];
        // The axis that crosses a leaf is the outer loop, so that the accessor changes leaves once for it.
        if ((z & 7) == 7) {
            for (int c = 0; c < 2; ++c)
                for (int a = 0; a < 2; ++a)
                    for (int b = 0; b < 2; ++b) v[a][b][c] = accessor_.getValue({x + a, y + b, z + c});
        } else if ((y & 7) == 7) {
            for (int b = 0; b < 2; ++b)
                for (int a = 0; a < 2; ++a)
                    for (int c = 0; c < 2; ++c) v[a][b][c] = accessor_.getValue({x + a, y + b, z + c});
        } else {
            for (int a = 0; a < 2; ++a)
                for (int b = 0; b < 2; ++b)
                    for (int c = 0; c < 2; ++c) v[a][b][c] = accessor_.getValue({x + a, y + b, z + c});
        }
        return interpolate(fx, fy, fz, v[0][0][0], v[0][0][1], v[0][1][0], v[0][1][1], v[1][0][0], v[1][0][1],
                           v[1][1][0], v[1][1][1]);
    }

    nanovdb::DefaultReadAccessor<float> accessor_;
};

/// The grid that TrackedMedium wants (see there).
struct NanoGrid {
    using Value = float;
    NanoCursor cursor() const { return NanoCursor(*grid->data().grid); }

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
