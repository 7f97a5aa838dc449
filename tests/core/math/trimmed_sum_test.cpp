#include "core/math/trimmed_sum.h"

#include <array>

#include "tests/support/catch.h"

using namespace mote::core;

TEST_CASE("A sum leaves out as many of the largest values as it says", "[trimmed_sum]") {
    const std::array<double, 6> values{4.0, 32.0, 1.0, 16.0, 2.0, 8.0};  // each sum has one set of terms
    double kept = 63.0, largest = 32.0;
    for (std::size_t left_out = 0; left_out <= values.size(); ++left_out, kept -= largest, largest /= 2.0) {
        std::array<double, 6> copy = values;
        CHECK(sum_without_largest(copy, left_out) == kept);
    }
}
