// Choice of the virtual point lights of a set that light a receiver, with their weights.
//
// A policy has for_each(lights, visit), which calls visit(WeightedVpl) for every chosen light of
// a set of so many. Weights are 1 where all are taken, and 1/p where they are sampled: the sum is unbiased as
// long as every light that can send light has a positive probability.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mote::lights {

/// A chosen light.
struct WeightedVpl {
    std::size_t index;    ///< of the light
    float weight = 1.0f;  ///< 1/p
};

/// Every `stride`-th from `first` on, before `end`, each once: all of them, a subset of them, or one.
struct VplRange {
    std::size_t first = 0, stride = 1, end = std::size_t(-1);  ///< indices of lights

    /// A single light.
    static VplRange one(std::size_t index) { return {index, 1, index + 1}; }

    /// True for a light of the range.
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
    std::span<const WeightedVpl> samples;  ///< in the order in which they are gathered

    /// Calls visit(WeightedVpl), as the top of this file says.
    template <typename Visit>
    void for_each(std::size_t, const Visit& visit) const {
        for (const WeightedVpl& light : samples) visit(light);
    }
};

}  // namespace mote::lights
