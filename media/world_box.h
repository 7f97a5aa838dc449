// The box in the world that a medium ends at, in double precision.
#pragma once

#include <algorithm>

#include "core/math/ray.h"
#include "core/math/transform.h"

namespace mote::media {

struct WorldBox {
    core::Vec3d lower{double(core::infinity)}, upper{-double(core::infinity)};

    /// The smallest one around a transformed box, as Mitsuba 3 bounds its volumes.
    static WorldBox around(const core::Vec3d& a, const core::Vec3d& b, const core::Transform& to_world) {
        WorldBox box;
        for (int corner = 0; corner < 8; ++corner) {
            const core::Vec3d p = to_world.point(
                core::Vec3d(corner & 1 ? b.x : a.x, corner & 2 ? b.y : a.y, corner & 4 ? b.z : a.z));
            box.lower = glm::min(box.lower, p), box.upper = glm::max(box.upper, p);
        }
        return box;
    }
    bool contains(const core::Vec3& p) const {
        const core::Vec3d q(p);
        return glm::all(glm::greaterThanEqual(q, lower)) && glm::all(glm::lessThanEqual(q, upper));
    }
    /// The part of [t0, t1] inside; false when there is none.
    bool clip(const core::Ray& ray, double& t0, double& t1) const {
        for (int axis = 0; axis < 3; ++axis) {
            const double o = ray.origin[axis], d = ray.direction[axis];
            if (d == 0.0) {
                if (o < lower[axis] || o > upper[axis]) return false;
                continue;
            }
            const double a = (lower[axis] - o) / d, b = (upper[axis] - o) / d;
            t0 = std::max(t0, std::min(a, b)), t1 = std::min(t1, std::max(a, b));
        }
        return t0 < t1;
    }
};

}  // namespace mote::media
