// How often merges are sought: the effort of a technique is the probability with which it finds a merge that
// is there, and a factor of its density (merge_kernels.h), so that any effort is unbiased, and techniques
// that find the same paths take over what it leaves. Its root is the chance of a light vertex to be in the
// tree, and again that of a query of an eye path: both cost less.
//
// In dense media a query beam passes hundreds of photons and beams, whose light it does not need; then a pass
// costs five times as much as its paths, for a fifth less noise.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "integrators/bidirectional/merge_kernels.h"

namespace mote::integrators {

/// One number for each technique; index Merge.
using PerMerge = std::array<double, merge_count>;
inline constexpr PerMerge full_efforts{1.0, 1.0, 1.0, 1.0};

/// Work of merges by technique, in units of one closest hit (core/render/counted_work.h).
struct MergeWork {
    PerMerge queries{};       ///< falls as the root of the effort
    PerMerge merges{};        ///< falls as the effort
    double of_lookups = 0.0;  ///< what lookups of the medium have of it
    std::uint64_t found = 0;  ///< merges

    /// A query that tested so many vertices or pieces of beams, and found so many merges.
    void add_query(Merge technique, std::size_t tested, std::size_t found_here, std::uint64_t lookups) {
        const double looked_up = 0.25 * double(lookups);
        queries[std::size_t(technique)] += 0.5;
        merges[std::size_t(technique)] += 0.1 * double(tested) + 0.4 * double(found_here) + looked_up;
        of_lookups += looked_up, found += found_here;
    }
    void add(const MergeWork& other) {
        for (std::size_t t = 0; t < merge_count; ++t)
            queries[t] += other.queries[t], merges[t] += other.merges[t];
        of_lookups += other.of_lookups, found += other.found;
    }
    /// At efforts where these counts are those of full ones.
    double at(const PerMerge& efforts) const {
        double work = 0.0;
        for (std::size_t t = 0; t < merge_count; ++t)
            work += std::sqrt(efforts[t]) * queries[t] + efforts[t] * merges[t];
        return work;
    }
};

}  // namespace mote::integrators
