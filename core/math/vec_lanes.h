// Points or directions of many lanes as a structure of arrays, for loops that the compiler makes vector
// instructions of.
#pragma once

#include "core/math/vec.h"

namespace mote::core {

/// N vectors, each component an array of its own.
template <int N>
struct alignas(64) VecLanes {
    float x[N] = {}, y[N] = {}, z[N] = {};

    Vec3 get(int lane) const { return {x[lane], y[lane], z[lane]}; }
    void set(int lane, const Vec3& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
};

}  // namespace mote::core
