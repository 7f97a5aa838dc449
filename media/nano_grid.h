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
    explicit NanoCursor(const nanovdb::FloatGrid& grid) : accessor_(grid.tree().root()) {
        enter_block(0, 0, 0);
    }

    /// `p` in index space, clamped to +-1e9 (load_vdb_grid refuses grids that reach so far).
    float lookup(const core::Vec3d& p) {
        const core::Vec3d q = glm::clamp(p, core::Vec3d(-1e9), core::Vec3d(1e9));
        const int x = floor_to_int(q.x), y = floor_to_int(q.y), z = floor_to_int(q.z);
        const float fx = float(q.x - x), fy = float(q.y - y), fz = float(q.z - z);
        // Within one leaf of 8^3 voxels, which is where two thirds of all lookups fall, all eight values lie
        // at fixed offsets from the first; where there is no leaf, a tile or the background gives all eight.
        if ((x & 7) != 7 && (y & 7) != 7 && (z & 7) != 7) {
            look_at(x, y, z);
            if (!values_) return uniform_;
            const float* v = values_ + (((x & 7) << 6) | ((y & 7) << 3) | (z & 7));
            return interpolate(fx, fy, fz, v[0], v[1], v[8], v[9], v[64], v[65], v[72], v[73]);
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
    void enter_block(int x, int y, int z) {
        x_ = x, y_ = y, z_ = z;
        const auto* leaf = accessor_.probeLeaf({x, y, z});
        values_ = leaf ? leaf->data()->mValues : nullptr;
        if (!leaf) uniform_ = accessor_.getValue({x, y, z});
    }
    float across_leaves(int x, int y, int z, float fx, float fy, float fz) {
        const bool cx = (x & 7) == 7, cy = (y & 7) == 7, cz = (z & 7) == 7;
        if (int(cx) + int(cy) + int(cz) > 1) return across_edges(x, y, z, fx, fy, fz);
        // One axis crosses, as a rule: a face of four values in this block, and one in the next.
        const int offset = ((x & 7) << 6) | ((y & 7) << 3) | (z & 7);
        const int stride = cx ? 64 : cy ? 8 : 1, first = cx ? 8 : 64, second = cz ? 8 : 1;
        const float f = cx ? fx : cy ? fy : fz, f1 = cx ? fy : fx, f2 = cz ? fy : fz;
        look_at(x, y, z);
        const float here = face(offset, first, second, f1, f2);
        enter_block(x + int(cx), y + int(cy), z + int(cz));
        return mix(here, face(offset - 7 * stride, first, second, f1, f2), f);
    }
    float face(int offset, int first, int second, float f1, float f2) const {
        if (!values_) return uniform_;
        const float* v = values_ + offset;
        return mix(mix(v[0], v[second], f2), mix(v[first], v[first + second], f2), f1);
    }
    float across_edges(int x, int y, int z, float fx, float fy, float fz) {
        float v[8];
        for (int i = 0; i < 8; ++i) {
            const int a = x + (i >> 2), b = y + ((i >> 1) & 1), c = z + (i & 1);
            look_at(a, b, c);
            v[i] = in_block(a, b, c);
        }
        return interpolate(fx, fy, fz, v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]);
    }
    void look_at(int x, int y, int z) {
        if ((((x ^ x_) | (y ^ y_) | (z ^ z_)) & ~7) != 0) enter_block(x, y, z);
    }
    float in_block(int x, int y, int z) const {
        return values_ ? values_[((x & 7) << 6) | ((y & 7) << 3) | (z & 7)] : uniform_;
    }

    nanovdb::DefaultReadAccessor<float> accessor_;
    int x_ = 0, y_ = 0, z_ = 0;      ///< a voxel of the block looked at last
    const float* values_ = nullptr;  ///< its leaf, or null: then uniform_ holds throughout the block
    float uniform_ = 0.0f;
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
