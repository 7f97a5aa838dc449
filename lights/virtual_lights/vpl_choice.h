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

/// Samples of a selector for a tile: n VPLs with weights 1 / (n p). A VPL may come more than once.
struct SampledVpls {
    std::span<const WeightedVpl> samples;

    /// Calls visit(WeightedVpl), as the top of this file says.
    template <typename Visit>
    void for_each(std::size_t, const Visit& visit) const {
        for (const WeightedVpl& light : samples) visit(light);
    }
};

}  // namespace mote::lights
