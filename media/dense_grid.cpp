// Majorants of dense voxels.
#include "media/dense_grid.h"

namespace mote::media {

template <typename Value>
MajorantGrid<Value> dense_majorants(const DenseVoxels& voxels) {
    const glm::ivec3 n = voxels.resolution;
    const auto voxel_at = [&](const Voxel& v) {
        return voxels.at<Value>(wrapped(int(v.x), n.x, voxels.wrap), wrapped(int(v.y), n.y, voxels.wrap),
                                wrapped(int(v.z), n.z, voxels.wrap));
    };
    typename MajorantGrid<Value>::Range border{voxel_at(Voxel(0)), voxel_at(Voxel(0))};
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y) {
            const bool inner_row =
                voxels.wrap == WrapMode::clamp && z > 0 && z < n.z - 1 && y > 0 && y < n.y - 1;
            for (int x = 0; x < n.x; x += inner_row ? std::max(1, n.x - 1) : 1) {
                const Value v = voxels.at<Value>(x, y, z);
                border.lower = glm::min(border.lower, v), border.upper = glm::max(border.upper, v);
            }
        }
    const Voxel lower(-1), upper(n);
    MajorantGrid<Value> grid(lower, upper, border);
    grid.add_block(lower, upper, voxel_at);
    grid.finish(border.lower);
    return grid;
}

template MajorantGrid<float> dense_majorants<float>(const DenseVoxels&);
template MajorantGrid<core::Rgb> dense_majorants<core::Rgb>(const DenseVoxels&);

}  // namespace mote::media
