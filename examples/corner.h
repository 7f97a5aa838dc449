// A corner as arrays of pixels: a wall at z = 4 m and a floor at y = 1 m (down), seen by a camera at the
// origin that looks along z.
#pragma once

#include <mote/core/math/vec.h>

#include <algorithm>
#include <vector>

namespace corner {

using mote::core::Vec3;

inline constexpr int width = 96, height = 96, pixels = width * height;

/// First surface of a pixel.
struct Seen {
    Vec3 position, normal;
    float distance;  ///< from the camera [m]
    bool floor;
};

inline Seen seen(int i) {
    const Vec3 film((float(i % width) + 0.5f) / width - 0.5f, (float(i / width) + 0.5f) / height - 0.5f,
                    1.0f);
    const Vec3 direction = glm::normalize(film);
    const float to_wall = 4.0f / direction.z,
                to_floor = direction.y > 0.0f ? 1.0f / direction.y : mote::core::infinity;
    const float t = std::min(to_wall, to_floor);
    return {t * direction, to_floor < to_wall ? Vec3(0, -1, 0) : Vec3(0, 0, -1), t, to_floor < to_wall};
}

/// All pixels, row by row from the top.
inline std::vector<Seen> view() {
    std::vector<Seen> result;
    for (int i = 0; i < pixels; ++i) result.push_back(seen(i));
    return result;
}

}  // namespace corner
