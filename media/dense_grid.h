// Dense voxels and their trilinear interpolation; outside they are continued by one of three rules.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/math/transform.h"
#include "media/majorant_grid.h"
#include "media/world_box.h"

namespace mote::media {

/// Continuation beyond the first and the last voxel of an axis, as in Mitsuba 3.
enum class WrapMode {
    clamp,   ///< the border's voxel
    repeat,  ///< the grid again
    mirror   ///< the grid reversed, then again
};

/// The voxel of 0..n-1 that stands at place i.
inline int wrapped(int i, int n, WrapMode mode) {
    if (mode == WrapMode::clamp) return std::clamp(i, 0, n - 1);
    const int period = int(detail::floor_div(i, n)), within = i - period * n;
    return mode == WrapMode::mirror && period % 2 != 0 ? n - 1 - within : within;
}

struct DenseVoxels {
    glm::ivec3 resolution{0};
    int channels = 1;  ///< 1 or 3, interleaved
    std::vector<float> values;
    WrapMode wrap = WrapMode::clamp;

    template <typename Value>
    Value at(int x, int y, int z) const {
        const std::size_t i =
            (std::size_t(z) * std::size_t(resolution.y) + std::size_t(y)) * std::size_t(resolution.x) +
            std::size_t(x);
        if constexpr (std::is_same_v<Value, float>)
            return values[i];
        else
            return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    }

    /// `p` in index space: voxel centres at integers. Clamped to +-1e9.
    template <typename Value>
    Value interpolate(const core::Vec3d& p) const {
        glm::ivec3 a, b;
        core::Vec3 f;
        for (int axis = 0; axis < 3; ++axis) {
            const double x = std::fmin(std::fmax(p[axis], -1e9), 1e9), whole = std::floor(x);
            a[axis] = int(whole), b[axis] = a[axis] + 1, f[axis] = float(x - whole);
            if (a[axis] >= 0 && b[axis] < resolution[axis]) continue;
            a[axis] = wrapped(a[axis], resolution[axis], wrap);
            b[axis] = wrapped(b[axis], resolution[axis], wrap);
        }
        const auto mix = [](const Value& u, const Value& v, float t) { return u + t * (v - u); };
        const Value y0z0 = mix(at<Value>(a.x, a.y, a.z), at<Value>(b.x, a.y, a.z), f.x);
        const Value y1z0 = mix(at<Value>(a.x, b.y, a.z), at<Value>(b.x, b.y, a.z), f.x);
        const Value y0z1 = mix(at<Value>(a.x, a.y, b.z), at<Value>(b.x, a.y, b.z), f.x);
        const Value y1z1 = mix(at<Value>(a.x, b.y, b.z), at<Value>(b.x, b.y, b.z), f.x);
        return mix(mix(y0z0, y1z0, f.y), mix(y0z1, y1z1, f.y), f.z);
    }
};

/// The grid that TrackedMedium wants (see there). V is float for one channel and Rgb for three.
template <typename V>
struct DenseGrid {
    using Value = V;
    struct Cursor {
        const DenseVoxels& voxels;
        Value lookup(const core::Vec3d& p) const { return voxels.interpolate<Value>(p); }
    };
    Cursor cursor() const { return {*voxels}; }

    std::shared_ptr<const DenseVoxels> voxels;
    core::Transform world_to_index;
    MajorantGrid<Value> majorants;
    std::string description;
    WorldBox box;
};

/// Bounds of the voxels on cells from one voxel below the first to one above the last, so that the half of a
/// border voxel that reaches into the box lies within the cells; outside, the bounds of the border voxels
/// hold for clamped grids, those of all voxels for the others.
template <typename Value>
MajorantGrid<Value> dense_majorants(const DenseVoxels& voxels);

}  // namespace mote::media
