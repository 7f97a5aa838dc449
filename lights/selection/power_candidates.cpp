#include "lights/selection/power_candidates.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

PowerCandidates::PowerCandidates(const LightHierarchy& lights)
    : lights_(lights), sums_(lights.size()), begins_(lights.size()) {
    double sum = 0.0;
    for (std::uint32_t place = 0; place < sums_.size(); ++place)
        sums_[place] = sum += double(lights.weight_at(place));
    std::uint32_t place = 0;
    for (std::size_t share = 0; share < begins_.size(); ++share) {
        const double begin = sum * double(share) / double(begins_.size());
        while (place + 1 < sums_.size() && sums_[place] <= begin) ++place;
        begins_[share] = place > 0 ? place - 1 : 0;  // rounding may put a number before its share
    }
}

void PowerCandidates::draw(std::uint32_t n, Rng& rng, std::vector<WeightedVpl>& drawn) const {
    if (sums_.empty()) return;
    const double total = sums_.back();
    std::uint32_t last = 0;
    bool any = false;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double u = std::min((double(i) + double(rng.next_float())) / double(n), 1.0 - 0x1p-53);
        std::uint32_t place = begins_[std::size_t(u * double(begins_.size()))];
        while (place + 1 < sums_.size() && sums_[place] <= u * total) ++place;
        const float weight = float(1.0 / (double(n) * probability(place)));
        if (any && place == last)
            drawn.back().weight += weight;
        else
            drawn.push_back({lights_.light_at(place), weight});
        last = place, any = true;
    }
}

}  // namespace mote::lights
