// The rows or columns of a grid within an interval.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mote::gathering {

/// Whole numbers from..to within [lower, upper] and [0, count); empty where from > to.
struct GridSteps {
    std::int64_t from, to;
    GridSteps(double lower, double upper, std::uint32_t count)
        : from(std::int64_t(std::ceil(std::clamp(lower, 0.0, double(count))))),
          to(std::int64_t(std::floor(std::clamp(upper, -1.0, double(count) - 1.0)))) {}
    bool empty() const { return from > to; }
};

inline double lowest_of(double a, double b, double c) { return std::min(a, std::min(b, c)); }
inline double highest_of(double a, double b, double c) { return std::max(a, std::max(b, c)); }

}  // namespace mote::gathering
