// Agreement of the links of a bundle that was built otherwise with those of an exact one.
#pragma once

#include <cmath>
#include <utility>

#include "gathering/ray_bundles/ray_bundle.h"

namespace mote::gathering {

struct LinkComparison {
    std::uint64_t exact = 0;   ///< links
    std::uint64_t other = 0;   ///< links of the other bundle
    std::uint64_t shared = 0;  ///< links whose ends lie within the tolerance of each other on the same ray

    double missing() const { return exact == 0 ? 0.0 : 1.0 - double(shared) / double(exact); }
    double wrong() const { return other == 0 ? 0.0 : 1.0 - double(shared) / double(other); }
    void add(const LinkComparison& o) { exact += o.exact, other += o.other, shared += o.shared; }
};

namespace link_comparison {

/// Distances of the two ends of a link along its ray [m].
using Ends = std::pair<float, float>;

inline void links_of(std::span<const BundleHit> hits, bool two_sided, std::vector<Ends>& links) {
    links.clear();
    for (std::size_t i = 0; i + 1 < hits.size(); ++i)
        if (two_sided || (hits[i].from_behind() && !hits[i + 1].from_behind()))
            links.emplace_back(hits[i].distance, hits[i + 1].distance);
}

inline std::uint64_t shared_links(const std::vector<Ends>& a, const std::vector<Ends>& b, float tolerance) {
    std::uint64_t shared = 0;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        if (std::fabs(a[i].first - b[j].first) <= tolerance &&
            std::fabs(a[i].second - b[j].second) <= tolerance)
            ++shared, ++i, ++j;
        else
            (a[i].second < b[j].second ? i : j) += 1;  // the one that ends first has no partner
    }
    return shared;
}

}  // namespace link_comparison

/// Both bundles have the same grid. `tolerance` is along the rays [m]; surfaces send and receive on both
/// sides where `two_sided`.
inline LinkComparison compare_links(const RayBundle& exact, const RayBundle& other, float tolerance,
                                    bool two_sided) {
    LinkComparison result;
    std::vector<link_comparison::Ends> a, b;
    for (std::size_t ray = 0; ray < exact.grid.rays(); ++ray) {
        link_comparison::links_of(exact.hits_of(ray), two_sided, a);
        link_comparison::links_of(other.hits_of(ray), two_sided, b);
        result.add({a.size(), b.size(), link_comparison::shared_links(a, b, tolerance)});
    }
    return result;
}

}  // namespace mote::gathering
