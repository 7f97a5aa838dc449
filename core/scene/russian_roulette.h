// Russian roulette, and the length of paths that lose nothing.
//
// Survival follows the throughput, so paths through absorbing scenes end soon and keep weights near one.
// Where nothing absorbs, throughput never falls: a lower chance would only raise the weights of the
// survivors, by 1/q a step, and with them the variance. Such paths continue untouched until they are very
// long, and only then are made to end.
#pragma once

#include <algorithm>

namespace mote::core {

inline constexpr int long_eye_path = 10000;  ///< vertices: diffusion through optical depth 30 takes hundreds
inline constexpr int long_light_path = 500;  ///< vertices: each of them is kept in memory

/// Survival probability at vertex number `depth` when `remaining` of the path's first throughput is left.
inline float survival_chance(float remaining, int depth, int long_path) {
    return std::min(remaining, depth < long_path ? 1.0f : 0.95f);
}

}  // namespace mote::core
