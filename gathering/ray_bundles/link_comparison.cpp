#include "gathering/ray_bundles/link_comparison.h"

#include <cmath>
#include <utility>

namespace mote::gathering {
namespace {

using Ends = std::pair<float, float>;

void links_of(std::span<const BundleHit> hits, bool two_sided, std::vector<Ends>& links) {
    links.clear();
    for (std::size_t i = 0; i + 1 < hits.size(); ++i)
        if (two_sided || (hits[i].from_behind() && !hits[i + 1].from_behind()))
            links.emplace_back(hits[i].distance, hits[i + 1].distance);
}

std::uint64_t shared_links(const std::vector<Ends>& a, const std::vector<Ends>& b, float tolerance) {
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

}  // namespace

LinkComparison compare_links(const RayBundle& exact, const RayBundle& other, float tolerance,
                             bool two_sided) {
    LinkComparison result;
    std::vector<Ends> a, b;
    for (std::size_t ray = 0; ray < exact.grid.rays(); ++ray) {
        links_of(exact.hits_of(ray), two_sided, a), links_of(other.hits_of(ray), two_sided, b);
        result.add({a.size(), b.size(), shared_links(a, b, tolerance)});
    }
    return result;
}

}  // namespace mote::gathering
