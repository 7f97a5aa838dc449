// Discs against the rays of a micro-buffer, eight neighbours of a row at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "core/math/vectorize.h"
#include "gathering/micro_buffers/fused.h"

namespace mote::gathering {

/// Local directions of a buffer's rays, coordinate by coordinate, padded so that eight can be read from any
/// ray on.
struct RayDirections {
    static constexpr std::uint32_t lanes = 8;

    std::uint32_t side = 0;
    std::vector<float> x, y, z;

    void resize(std::uint32_t new_side) {
        side = new_side;
        for (auto* axis : {&x, &y, &z}) axis->assign(std::size_t(side) * side + lanes, 0.0f);
    }
    void set(std::uint32_t ray, const core::Vec3& w) { x[ray] = w.x, y[ray] = w.y, z[ray] = w.z; }
    core::Vec3 of(std::uint32_t ray) const { return {x[ray], y[ray], z[ray]}; }
};

/// A node as a receiver sees it, in the receiver's frame.
struct LocalDisc {
    core::Vec3 center, axis;  ///< [m], unit
    float radius;             ///< [m]
    float nearest_back;       ///< from behind it is met beyond this only [m]; infinity: never
    std::uint32_t hit;        ///< MicroTexel::hit, of its front
};

/// Texels [x0, x1) of rows [y0, y1).
struct TexelBox {
    std::int32_t x0, y0, x1, y1;
};

/// The nearest hits of all rays, padded as RayDirections are.
struct DepthRows {
    float* distance;
    std::uint32_t* hit;
};

/// Keeps the disc where it is nearer than what is there. All rays within the box are tried, and some beside
/// it: a ray meets the disc or does not, the box only excludes rays that need no test.
inline void fill_box(const RayDirections& rays, const LocalDisc& disc, const TexelBox& box, DepthRows out) {
    constexpr std::uint32_t back_bit = 0x80000000u;
    const core::Vec3 c = disc.center, a = disc.axis;
    const float plane = glm::dot(a, c), r2 = disc.radius * disc.radius, back = disc.nearest_back;
    for (std::int32_t row = box.y0; row < box.y1; ++row)
        for (std::int32_t column = box.x0; column < box.x1; column += std::int32_t(RayDirections::lanes)) {
            const std::size_t at = std::size_t(row) * rays.side + std::size_t(column);
            const float *wx = rays.x.data() + at, *wy = rays.y.data() + at, *wz = rays.z.data() + at;
            float* distance = out.distance + at;
            std::uint32_t* hit = out.hit + at;
            MOTE_INDEPENDENT_LANES
            for (std::uint32_t i = 0; i < RayDirections::lanes; ++i) {
                const float facing = fused_dot(a.x, a.y, a.z, wx[i], wy[i], wz[i]), t = plane / facing;
                const float x = fused(t, wx[i], -c.x), y = fused(t, wy[i], -c.y), z = fused(t, wz[i], -c.z);
                const bool behind = facing > 0.0f;
                const bool met =
                    (fused_dot(x, y, z, x, y, z) <= r2) & (t > (behind ? back : 0.0f)) & (t < distance[i]);
                distance[i] = met ? t : distance[i];
                hit[i] = met ? (behind ? disc.hit | back_bit : disc.hit) : hit[i];
            }
        }
}

}  // namespace mote::gathering
