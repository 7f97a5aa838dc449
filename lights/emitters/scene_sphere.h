// Where particles from lights at infinity start: a disk as wide as the scene's bounding sphere, perpendicular
// to the particle's direction and touching the sphere (Pharr, Jakob, Humphreys 2016, section 16.1.2).
#pragma once

#include "core/math/frame.h"
#include "core/math/warp.h"

namespace mote::lights {

struct SceneSphere {
    core::Vec3 center{0, 0, 0};
    float radius = 1.0f;

    SceneSphere() = default;
    /// A little larger than requested, so that rounding starts no particle inside the scene.
    SceneSphere(const core::Vec3& c, float r)
        : center(c), radius(std::fmax(r * 1.001f + 1e-6f * glm::length(c), 1e-18f)) {}

    /// Density of the origin over the disk [1/m^2].
    float pdf_area() const { return 1.0f / disk_area(); }
    /// Density of the ray through p: zero where it misses the disk. The rim is a little wider than the
    /// disk, by what rounding moves its points.
    float pdf_area(const core::Vec3& p, const core::Vec3& direction) const {
        const core::Vec3d d(direction), from_center = core::Vec3d(p) - core::Vec3d(center);
        const double along = glm::dot(from_center, d) / glm::dot(d, d);
        const core::Vec3d across = from_center - along * d;
        const double reach = 1.00001 * double(radius);
        return glm::dot(across, across) <= reach * reach ? pdf_area() : 0.0f;
    }
    float disk_area() const { return core::pi * radius * radius; }

    core::Vec3 origin_on_disk(const core::Vec3& direction, const core::Vec2& u) const {
        const core::Frame frame(direction);
        const core::Vec2 d = core::square_to_disk(u);
        return center + radius * (d.x * frame.s + d.y * frame.t - direction);
    }
};

}  // namespace mote::lights
