// Techniques that `mote_upbp` may use less often, and their counted work: the same on every machine, with any
// number of threads.
#pragma once

#include <array>

#include "integrators/bidirectional/merge_kernels.h"
#include "integrators/bidirectional/strategies.h"

namespace mote::integrators {

/// Merges by their index, then sampled lights (s = 1) and connections (s, t > 1).
inline constexpr std::size_t technique_count = merge_count + 2, light_technique = merge_count,
                             connection_technique = merge_count + 1;
inline constexpr std::array<const char*, technique_count> technique_names{"surf", "pp3d",   "pb2d",
                                                                          "bb1d", "lights", "connections"};
/// One number for each technique.
using PerTechnique = std::array<double, technique_count>;
inline constexpr PerTechnique full_efforts{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

/// In units of one closest hit (core/render/counted_work.h).
struct TechniqueWork {
    PerTechnique hits{};

    void add_query(Merge technique, std::size_t candidates, std::uint64_t lookups) {
        constexpr double of_query = 0.5, of_candidate = 0.25;
        hits[std::size_t(technique)] += of_query + of_candidate * double(candidates) + 0.25 * double(lookups);
    }
    void add(const ConnectionWork& work) {
        hits[light_technique] += work.light, hits[connection_technique] += work.connection;
    }
    void add(const TechniqueWork& other) {
        for (std::size_t t = 0; t < technique_count; ++t) hits[t] += other.hits[t];
    }
};

}  // namespace mote::integrators
