// A number for each of the sixteen lanes of a packet.
#pragma once

#include <concepts>

namespace mote::core {

/// Side by side, so that the compiler makes vector instructions of loops over them.
struct alignas(64) Lanes {
    static constexpr int width = 16;
    float value[width] = {};  ///< by lane

    template <std::integral Index>
    float& operator[](Index lane) {
        return value[lane];
    }
    template <std::integral Index>
    const float& operator[](Index lane) const {
        return value[lane];
    }
    float* begin() { return value; }
    float* end() { return value + width; }
    const float* begin() const { return value; }
    const float* end() const { return value + width; }

    float sum() const {
        float s = 0.0f;
        for (const float v : value) s += v;
        return s;
    }
};

}  // namespace mote::core
