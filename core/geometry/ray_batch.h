// Many rays and their first hits as structures of arrays, for algorithms that advance many paths at once.
#pragma once

#include <cstdint>

#include "core/geometry/shape.h"
#include "core/math/ray.h"
#include "core/math/vec_lanes.h"

namespace mote::core {

/// Rays [0, count).
struct RayBatch {
    static constexpr int capacity = 256;
    int count = 0;
    VecLanes<capacity> origin, direction;
    alignas(64) float t_min[capacity] = {}, t_max[capacity] = {};

    Ray ray(int i) const { return {origin.get(i), direction.get(i), t_min[i], t_max[i]}; }
    void set(int i, const Ray& ray) {
        origin.set(i, ray.origin), direction.set(i, ray.direction);
        t_min[i] = ray.t_min, t_max[i] = ray.t_max;
    }
};

/// Members of SurfaceHit that most materials need, by ray; RayTracer::surface_hit() makes the others.
struct HitBatch {
    static constexpr int capacity = RayBatch::capacity;
    const Shape* shape[capacity] = {};  ///< null: the ray met no surface
    VecLanes<capacity> position, geometric_normal, shading_normal;
    alignas(64) float error[capacity] = {};
    // As Embree reports them:
    alignas(64) float t[capacity] = {}, u[capacity] = {}, v[capacity] = {};
    alignas(64) std::uint32_t geometry[capacity] = {}, primitive[capacity] = {}, instance[capacity] = {};
};

}  // namespace mote::core
