// Shares of seeds whose interval of 95 % confidence contains the error.
#pragma once

#include <cmath>
#include <cstdint>

#include "tests/support/catch.h"

namespace mote::tests {

/// CHECKs that a share of so many seeds is 95 % within three standard deviations.
inline void check_coverage(double contained, std::uint64_t seeds) {
    const double within = 3.0 * std::sqrt(0.95 * 0.05 / double(seeds));
    CHECK(contained > 0.95 - within);
    CHECK(contained < 0.95 + within);
}

}  // namespace mote::tests
