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

void PowerCandidates::draw(const LightCluster& group, std::uint32_t n, Rng& rng,
                           std::vector<WeightedVpl>& drawn) const {
    if (sums_.empty()) return;
    const std::uint32_t end = group.first + group.count;
    const double begin = group.first > 0 ? sums_[group.first - 1] : 0.0, power = sums_[end - 1] - begin;
    const double shares_per_power = double(begins_.size()) / sums_.back();
    std::uint32_t last = end;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double u = begin + power * (double(i) + double(rng.next_float())) / double(n);
        const std::size_t share = std::min(std::size_t(u * shares_per_power), begins_.size() - 1);
        std::uint32_t place = std::clamp(begins_[share], group.first, end - 1);
        while (place + 1 < end && sums_[place] <= u) ++place;
        const double own = sums_[place] - (place > 0 ? sums_[place - 1] : 0.0);
        const auto weight = float(power / (double(n) * own));
        if (place == last)
            drawn.back().weight += weight;
        else
            drawn.push_back({lights_.light_at(place), weight});
        last = place;
    }
}

}  // namespace mote::lights
