// How often merges are sought: the effort of a technique is the probability of a query at an eye vertex or
// along an eye path's edge. It is a factor of the technique's density (merge_kernels.h), so that any is
// unbiased, and techniques that find the same paths take over what it leaves.
//
// In dense media a query beam passes hundreds of photons and beams, whose light it does not need; then a pass
// costs five times as much as its paths, for a fifth less noise.
#pragma once

#include <array>
#include <cstdint>

#include "integrators/bidirectional/merge_kernels.h"

namespace mote::integrators {

/// One number for each technique; index Merge.
using PerMerge = std::array<double, merge_count>;
inline constexpr PerMerge full_efforts{1.0, 1.0, 1.0, 1.0};

/// Work of merges by technique, in units of one closest hit (core/render/counted_work.h).
struct MergeWork {
    PerMerge hits{};
    double of_lookups = 0.0;  ///< what lookups of the medium have of it
    std::uint64_t found = 0;  ///< merges

    /// A query that tested so many vertices or pieces of beams, and found so many merges.
    void add_query(Merge technique, std::size_t tested, std::size_t found_here, std::uint64_t lookups) {
        const double looked_up = 0.25 * double(lookups);
        hits[std::size_t(technique)] += 0.5 + 0.1 * double(tested) + 0.4 * double(found_here) + looked_up;
        of_lookups += looked_up, found += found_here;
    }
    void add(const MergeWork& other) {
        for (std::size_t t = 0; t < merge_count; ++t) hits[t] += other.hits[t];
        of_lookups += other.of_lookups, found += other.found;
    }
};

}  // namespace mote::integrators
