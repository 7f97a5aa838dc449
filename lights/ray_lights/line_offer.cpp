#include "lights/ray_lights/line_offer.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

void LineOffer::add(std::uint32_t light, bool ray, float weight, const LaneFloats& expected) {
    lights_.push_back({light, ray, weight});
    LaneFloats& weighted = expected_.emplace_back();
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        weighted.of[i] = expected.of[i] * weight;
        total_.of[i] += weighted.of[i];
    }
}

void LineOffer::pick(int lane, float step, float start, std::vector<LinePick>& picks) const {
    picks.clear();
    float next = start * step;  // how far it is to the next step
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        const float expected = expected_[k].of[lane];
        if (!(expected > 0.0f)) continue;
        if (!(step > 0.0f)) {
            picks.push_back(lights_[k]);
            continue;
        }
        const LinePick& light = lights_[k];
        const float weight = light.weight * (step / expected);
        int steps = 0;
        for (; next < expected; next += step) ++steps;
        next -= expected;
        // Points on ray lights are drawn anew each time; a VPL is the same.
        for (int n = 0; n < (light.ray ? steps : std::min(steps, 1)); ++n)
            picks.push_back({light.light, light.ray, light.ray ? weight : weight * float(steps)});
    }
}

}  // namespace mote::lights
