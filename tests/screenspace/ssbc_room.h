// A box with two blocks in it, as a picture: corners, contacts, silhouettes, surfaces at a slant.
#pragma once

#include "tests/screenspace/ssbc_pictures.h"

namespace mote::tests {

inline std::vector<Wall> room_walls() {
    std::vector<Wall> walls;
    const auto add = [&](core::Vec3d c, core::Vec3d u, core::Vec3d v, core::Rgb r) {
        walls.push_back({c, u, v, r});
    };
    const core::Rgb white(0.7f);
    add({0, -1, 0}, {0, 0, 1}, {1, 0, 0}, white), add({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, white);
    add({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, white);
    add({-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6f, 0.1f, 0.1f}),
        add({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0.1f, 0.6f, 0.1f});
    const auto block = [&](core::Vec3d c, double h, double s, double angle) {
        const core::Vec3d x(std::cos(angle), 0, std::sin(angle)), y(0, 1, 0),
            z(-std::sin(angle), 0, std::cos(angle));
        add(c + y * h, x * s, z * s, white);
        for (const core::Vec3d& side : {x, -x}) add(c + side * s, y * h, z * s, white);
        for (const core::Vec3d& side : {z, -z}) add(c + side * s, y * h, x * s, white);
    };
    block({-0.35, -0.4, -0.35}, 0.6, 0.3, 0.3), block({0.35, -0.7, 0.35}, 0.3, 0.3, -0.3);
    for (Wall& w : walls)
        w.radiance = [](const core::Vec3d& p) {
            return float(0.5 + 0.3 * std::sin(3.0 * p.x + 2.0 * p.y) * std::cos(2.0 * p.z));
        };
    return walls;
}

inline TestPicture room(int width) {
    return picture_of(room_walls(),
                      {{0.2, 0.3, 3.6}, {0, 0, 0}, {0, 1, 0}, std::tan(0.35), width, width * 3 / 4});
}

}  // namespace mote::tests
