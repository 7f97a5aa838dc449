// Majorants of dense voxels.
#include "media/dense_grid.h"

namespace mote::media {

template <typename Value>
MajorantGrid<Value> dense_majorants(const DenseVoxels& voxels) {
    const glm::ivec3 n = voxels.resolution;
    const auto clamped = [&](const Voxel& v) {
        const glm::ivec3 c = glm::clamp(glm::ivec3(v), glm::ivec3(0), n - 1);
        return voxels.at<Value>(c.x, c.y, c.z);
    };
    typename MajorantGrid<Value>::Range border{clamped(Voxel(0)), clamped(Voxel(0))};
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y) {
            const bool inner_row = z > 0 && z < n.z - 1 && y > 0 && y < n.y - 1;
            for (int x = 0; x < n.x; x += inner_row ? std::max(1, n.x - 1) : 1) {
                const Value v = voxels.at<Value>(x, y, z);
                border.lower = glm::min(border.lower, v), border.upper = glm::max(border.upper, v);
            }
        }
    const Voxel lower(-1), upper(n);
    MajorantGrid<Value> grid(lower, upper, border);
    grid.add_block(lower, upper, clamped);
    grid.finish(border.lower);
    return grid;
}

template MajorantGrid<float> dense_majorants<float>(const DenseVoxels&);
template MajorantGrid<core::Rgb> dense_majorants<core::Rgb>(const DenseVoxels&);

}  // namespace mote::media
