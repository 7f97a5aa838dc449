// Russian roulette, and the length of paths that lose nothing.
//
// Survival follows the throughput, so paths through absorbing scenes end soon and keep weights near one.
// Where nothing absorbs, throughput never falls: a lower chance would only raise the weights of the
// survivors, by 1/q a step, and with them the variance. Such paths continue untouched until they are very
// long, and only then are made to end.
#pragma once

#include <algorithm>

namespace mote::core {

/// When paths that lose nothing are made to end.
struct LongPath {
    int vertices;    ///< up to which they continue untouched
    float survival;  ///< at each vertex beyond; weights grow by its inverse
};

/// Diffusion through optical depth 30 takes hundreds of vertices.
inline constexpr LongPath long_eye_path{10000, 0.95f};
/// Each vertex is kept in memory. A path that ends at a light after n vertices on average needs a survival
/// above 1 - 1 / n: below, weights grow faster than paths end, and what lies beyond is in no image (a white
/// room whose lamp is met every 500 vertices lost a third of its light at 0.95).
inline constexpr LongPath long_light_path{500, 0.999f};

/// Survival probability at vertex number `depth` when `remaining` of the path's first throughput is left.
inline float survival_chance(float remaining, int depth, const LongPath& path) {
    return std::min(remaining, depth < path.vertices ? 1.0f : path.survival);
}

}  // namespace mote::core
