// The values of a grid in one plain array: what many lookups at once want, eight to a vector.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"
#include "core/math/vectorize.h"
#include "media/majorant_grid.h"

namespace mote::media {

class VoxelCopy {
  public:
    static constexpr std::int64_t max_voxels = std::int64_t(1) << 24;
    static constexpr int width = 8;  ///< points of a step of mean_along()

    VoxelCopy() = default;
    /// From `lower` to `upper`, where `value_at(Voxel)` is what stands there. Stays empty for more voxels.
    template <typename ValueAt>
    VoxelCopy(const Voxel& lower, const Voxel& upper, const ValueAt& value_at) : lower_(lower) {
        const Voxel size = upper - lower + Voxel(1);
        if (double(size.x) * double(size.y) * double(size.z) > double(max_voxels)) return;
        if (size.x < 2 || size.y < 2 || size.z < 2) return;
        size_ = glm::ivec3(size);
        values_.reserve(std::size_t(size.x * size.y * size.z));
        for (std::int64_t x = 0; x < size.x; ++x)
            for (std::int64_t y = 0; y < size.y; ++y)
                for (std::int64_t z = 0; z < size.z; ++z) values_.push_back(value_at(lower + Voxel(x, y, z)));
    }
    bool empty() const { return values_.empty(); }
    std::size_t memory_bytes() const { return values_.size() * sizeof(float); }

    /// The mean of the trilinear values at from + (k + first) step, for k below `count`, a multiple of width;
    /// beyond the border those of the border. Positions are in index space.
    float mean_along(const core::Vec3d& from, const core::Vec3d& step, float first, int count) const {
        const core::Vec3 o(from - core::Vec3d(lower_)), d(step);
        // The last voxel with a neighbour, and the largest place before that neighbour.
        const float end_x = below(size_.x), end_y = below(size_.y), end_z = below(size_.z);
        const std::int32_t row = size_.z, slice = size_.y * size_.z;
        const float* const values = values_.data();
        float sums[width] = {};
        for (int begin = 0; begin < count; begin += width) {
            MOTE_INDEPENDENT_LANES
            for (int lane = 0; lane < width; ++lane) {
                const float t = float(begin + lane) + first;
                const float x = core::min_of(core::max_of(o.x + t * d.x, 0.0f), end_x);
                const float y = core::min_of(core::max_of(o.y + t * d.y, 0.0f), end_y);
                const float z = core::min_of(core::max_of(o.z + t * d.z, 0.0f), end_z);
                const auto ix = std::int32_t(x), iy = std::int32_t(y), iz = std::int32_t(z);
                const float fx = x - float(ix), fy = y - float(iy), fz = z - float(iz);
                const std::int32_t at = ix * slice + iy * row + iz;
                const float v00 = mix(values[at], values[at + 1], fz);
                const float v01 = mix(values[at + row], values[at + row + 1], fz);
                const float v10 = mix(values[at + slice], values[at + slice + 1], fz);
                const float v11 = mix(values[at + slice + row], values[at + slice + row + 1], fz);
                sums[lane] += mix(mix(v00, v01, fy), mix(v10, v11, fy), fx);
            }
        }
        float sum = 0.0f;
        for (const float s : sums) sum += s;
        return sum / float(count);
    }

  private:
    static float mix(float a, float b, float t) { return a + t * (b - a); }
    static float below(int size) { return std::nextafter(float(size - 1), 0.0f); }

    Voxel lower_{0};
    glm::ivec3 size_{0};
    std::vector<float> values_;  ///< z fastest
};

}  // namespace mote::media
