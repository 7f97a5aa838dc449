// A layer for each strategy: light of paths of up to so many edges, by the technique (s, t) that found it.
#pragma once

#include <fmt/format.h>

#include "core/film/pass_image.h"

namespace mote::integrators {

/// Techniques in the order of their layers: for e = 1, 2, ... edges those with s = 0 ... e - 1, and for e > 1
/// the one that joins a light path to the lens (s = e, t = 1).
inline std::size_t strategy_index(int s, int t) {
    const int edges = s + t - 1;
    std::size_t before = 0;
    for (int e = 1; e < edges; ++e) before += std::size_t(e) + (e > 1);
    return before + std::size_t(s);
}

inline void append_strategy_layers(std::vector<core::Layer>& layers, int max_edges) {
    for (int e = 1; e <= max_edges; ++e)
        for (int s = 0; s <= (e > 1 ? e : 0); ++s) {
            const int t = e + 1 - s;
            layers.push_back({fmt::format("s{}_t{}", s, t),
                              fmt::format("paths of {} edges found with {} vertices from a light and {} from "
                                          "the camera; part of the other layers",
                                          e, s, t),
                              true});
        }
}

}  // namespace mote::integrators
