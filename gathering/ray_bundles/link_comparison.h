// Agreement of the links of a bundle that was built otherwise with those of an exact one.
#pragma once

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

/// Both bundles have the same grid. `tolerance` is along the rays [m]; surfaces send and receive on both
/// sides where `two_sided`.
LinkComparison compare_links(const RayBundle& exact, const RayBundle& other, float tolerance, bool two_sided);

}  // namespace mote::gathering
