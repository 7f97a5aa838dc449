// How often techniques are tried: the effort of one is the probability with which it finds a path that is
// there, and a factor of its density (merge_kernels.h), so that any effort is unbiased, and techniques that
// find the same paths take over what it leaves. Of a merge its root is the chance of a light vertex to be in
// the tree, and again that of a query of an eye path: both cost less. Connections of an eye vertex are tried
// together.
//
// In dense media a query beam passes hundreds of photons and beams, whose light it does not need; then a pass
// costs five times as much as its paths, for a fifth less noise. And a path of twenty vertices is found by
// twenty connections, which the balance heuristic takes for independent samples: but they share one light
// path and one eye path, and together are noisier than merges with many light paths.
#pragma once

#include <cmath>

#include "core/render/counted_work.h"
#include "integrators/bidirectional/strategies.h"

namespace mote::integrators {

/// Work by technique, in units of one closest hit (core/render/counted_work.h).
struct TechniqueWork {
    PerTechnique queries{};    ///< falls as the root of the effort
    PerTechnique finds{};      ///< falls as the effort
    double of_pass = 0.0;      ///< what the pass counts of it as rays and lookups
    std::uint64_t merges = 0;  ///< found

    /// A query that tested so many vertices or pieces of beams, and found so many merges.
    void add_query(Merge technique, std::size_t tested, std::size_t found, std::uint64_t lookups) {
        const double looked_up = core::work_of_lookup * double(lookups);
        queries[std::size_t(technique)] += 0.5;
        finds[std::size_t(technique)] += 0.1 * double(tested) + 1.25 * double(found) + looked_up;
        of_pass += looked_up, merges += found;
    }
    void add(const ConnectionCounts& c) {
        const double tests =
            core::work_of_occlusion * double(c.rays) + core::work_of_lookup * double(c.lookups);
        finds[by_connection] += 0.1 * double(c.pairs) + tests, of_pass += tests;
    }
    void add(const TechniqueWork& other) {
        for (std::size_t t = 0; t < technique_count; ++t)
            queries[t] += other.queries[t], finds[t] += other.finds[t];
        of_pass += other.of_pass, merges += other.merges;
    }
    bool uses(std::size_t t) const { return queries[t] + finds[t] > 0.0; }
    /// At efforts where these counts are those of full ones.
    double at(const PerTechnique& efforts) const {
        double work = 0.0;
        for (std::size_t t = 0; t < technique_count; ++t)
            work += std::sqrt(efforts[t]) * queries[t] + efforts[t] * finds[t];
        return work;
    }
};

}  // namespace mote::integrators
