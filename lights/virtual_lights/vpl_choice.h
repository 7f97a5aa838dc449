// Which virtual point lights of a set a receiver looks at, and how often each one counts.
//
// A policy has for_each(lights, visit), which calls visit(WeightedVpl) for every light that is looked at, of
// a set of so many. Weights are 1 where all are taken, and 1/p where they are drawn: the sum is unbiased as
// long as every light that can send light has a chance.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mote::lights {

/// A light that is looked at.
struct WeightedVpl {
    std::size_t index;    ///< of the light
    float weight = 1.0f;  ///< how often it counts
};

/// Every `stride`-th from `first` on, before `end`, each once: all of them, a share of them, or one.
struct VplRange {
    std::size_t first = 0, stride = 1, end = std::size_t(-1);  ///< indices of lights

    /// A single light.
    static VplRange one(std::size_t index) { return {index, 1, index + 1}; }

    /// Is this light among them?
    bool contains(std::size_t index) const {
        return index >= first && index < end && (index - first) % stride == 0;
    }
    /// Calls visit(WeightedVpl), as the top of this file says.
    template <typename Visit>
    void for_each(std::size_t lights, const Visit& visit) const {
        for (std::size_t j = first; j < std::min(end, lights); j += stride) visit(WeightedVpl{j});
    }
};

/// Of a range, the lights that a list names, each once, and of all others every `rest`-th, which counts
/// `rest` times: which ones begins with `offset`, and the sum is unbiased where that is drawn evenly from [0,
/// rest).
struct ListedVpls {
    VplRange range;                       ///< of all
    std::span<const std::uint64_t> list;  ///< a bit for each light, 64 a number
    std::size_t rest = 1, offset = 0;     ///< of the lights that the list does not name

    /// Calls visit(WeightedVpl), as the top of this file says.
    template <typename Visit>
    void for_each(std::size_t lights, const Visit& visit) const {
        std::size_t others = offset;
        range.for_each(lights, [&](const WeightedVpl& light) {
            if (list[light.index / 64] >> (light.index % 64) & 1)
                visit(light);
            else if (others++ % rest == 0)
                visit(WeightedVpl{light.index, float(rest)});
        });
    }
};

/// What a selector has drawn for a tile: n lights with weights 1 / (n p). A light may come more than once.
struct DrawnVpls {
    std::span<const WeightedVpl> drawn;  ///< in the order of the draws

    /// Calls visit(WeightedVpl), as the top of this file says.
    template <typename Visit>
    void for_each(std::size_t, const Visit& visit) const {
        for (const WeightedVpl& light : drawn) visit(light);
    }
};

}  // namespace mote::lights
