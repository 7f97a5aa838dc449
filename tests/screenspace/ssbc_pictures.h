// Pictures of rectangles, seen by a pinhole camera and ray cast here: nothing of the library is used to make
// them.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "screenspace/ssbc/ssbc_surfaces.h"

namespace mote::tests {

/// All points p with |dot(p - centre, u)| <= |u|^2 and so for v; infinite planes are very large ones.
struct Wall {
    core::Vec3d centre, u, v;
    core::Rgb reflectance{0.8f};
    std::function<float(const core::Vec3d&)> radiance = [](const core::Vec3d&) { return 1.0f; };
    core::Vec3d normal() const { return glm::normalize(glm::cross(u, v)); }
};

/// A pinhole camera; `tangent` is that of half the vertical field of view.
struct Pinhole {
    core::Vec3d eye, target, up;
    double tangent;
    int width, height;
    core::Vec3d direction(double x, double y) const {  ///< through a point of the film, 1 along the axis
        const core::Vec3d f = glm::normalize(target - eye), r = glm::normalize(glm::cross(f, up)),
                          u = glm::cross(r, f);
        const double scale = 2.0 * tangent / height;
        return f + r * ((x - 0.5 * width) * scale) - u * ((y - 0.5 * height) * scale);
    }
    /// Solid angle of the pixel around that direction: area on the film times cosine over squared distance.
    double solid_angle(const core::Vec3d& d) const {
        const double size = 2.0 * tangent / height;
        return size * size / std::pow(glm::length(d), 3.0);
    }
};

struct TestPicture {
    screenspace::SsbcSurfaces surfaces;
    std::vector<core::Rgb> light;  ///< reflected radiance
    std::vector<int> wall;         ///< which one is seen; -1: none
    std::size_t index(int x, int y) const {
        return std::size_t(y) * std::size_t(surfaces.width) + std::size_t(x);
    }
};

struct WallHit {
    int wall;
    double t;
};

inline std::optional<WallHit> first_hit(const std::vector<Wall>& walls, const core::Vec3d& o,
                                        const core::Vec3d& d) {
    std::optional<WallHit> best;
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const core::Vec3d n = walls[w].normal();
        const double t = glm::dot(walls[w].centre - o, n) / glm::dot(d, n);
        if (!(t > 1e-6) || (best && t >= best->t)) continue;
        const core::Vec3d local = o + t * d - walls[w].centre;
        if (std::abs(glm::dot(local, walls[w].u)) > glm::dot(walls[w].u, walls[w].u)) continue;
        if (std::abs(glm::dot(local, walls[w].v)) > glm::dot(walls[w].v, walls[w].v)) continue;
        best = WallHit{int(w), t};
    }
    return best;
}

inline TestPicture picture_of(const std::vector<Wall>& walls, const Pinhole& camera) {
    TestPicture picture{screenspace::SsbcSurfaces(camera.width, camera.height), {}, {}};
    picture.light.assign(picture.surfaces.pixel_count(), core::Rgb(0.0f)),
        picture.wall.assign(picture.light.size(), -1);
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const std::size_t i = picture.index(x, y);
            const core::Vec3d d = camera.direction(x + 0.5, y + 0.5);
            const auto hit = first_hit(walls, camera.eye, d);
            if (!hit) continue;
            const Wall& wall = walls[std::size_t(hit->wall)];
            const core::Vec3d p = camera.eye + hit->t * d, to_viewer = camera.eye - p;
            const double distance = glm::length(to_viewer);
            const double cosine = std::abs(glm::dot(wall.normal(), to_viewer)) / distance;
            picture.surfaces.set(i, core::Vec3(p), core::Vec3(wall.normal()), core::Vec3(to_viewer),
                                 float(camera.solid_angle(d) * distance * distance / cosine),
                                 wall.reflectance);
            picture.light[i] = core::Rgb(wall.radiance(p)), picture.wall[i] = hit->wall;
        }
    return picture;
}

}  // namespace mote::tests
