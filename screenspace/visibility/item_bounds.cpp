#include "screenspace/visibility/item_bounds.h"

#include <cmath>

namespace mote::screenspace {

namespace {

/// Pixels count from their corners, their middles lie half a pixel beyond; far away is far enough.
int first_at_or_above(float v) { return int(std::ceil(std::clamp(v, -1e9f, 1e9f))); }
int last_at_or_below(float v) { return int(std::floor(std::clamp(v, -1e9f, 1e9f))); }

struct Reach {
    float low, high;
};

ItemBounds octagon(const Reach& x, const Reach& y, const Reach& sum, const Reach& difference) {
    if (!(x.low <= x.high)) return {};
    ItemBounds b;
    b.rectangle = {first_at_or_above(x.low - 0.5f), first_at_or_above(y.low - 0.5f),
                   last_at_or_below(x.high - 0.5f) + 1, last_at_or_below(y.high - 0.5f) + 1};
    b.sum0 = first_at_or_above(sum.low - 1.0f), b.sum1 = last_at_or_below(sum.high - 1.0f);
    b.difference0 = first_at_or_above(difference.low), b.difference1 = last_at_or_below(difference.high);
    return b;
}

}  // namespace

ItemBounds bounds_of_outline(float x, float y, float reach_x, float reach_y, float reach_sum,
                             float reach_difference) {
    // A thousandth of a pixel is more than rounding moves anything.
    const auto around = [](float middle, float r) { return Reach{middle - r - 1e-3f, middle + r + 1e-3f}; };
    return octagon(around(x, reach_x), around(y, reach_y), around(x + y, reach_sum),
                   around(x - y, reach_difference));
}

}  // namespace mote::screenspace
