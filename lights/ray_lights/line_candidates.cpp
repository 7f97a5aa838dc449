#include "lights/ray_lights/line_candidates.h"

namespace mote::lights {

using namespace core;

namespace {

/// Connects to a light, which reaches up to `expected`, at each step from `next` on. Returns the one behind.
float connect_by_steps(const LineChoice& light, float expected, float step, float next,
                       std::vector<LineChoice>& choices) {
    if (!(step > 0.0f)) {
        choices.push_back(light);
        return expected;
    }
    int steps = 0;
    for (; next < expected; next += step) ++steps;
    const float weight = light.weight * (step / expected);
    // Points on ray lights are drawn anew each time; a VPL is the same.
    if (light.ray)
        choices.insert(choices.end(), std::size_t(steps), {light.light, true, weight});
    else
        choices.push_back({light.light, false, weight * float(steps)});
    return next;
}

}  // namespace

void LineCandidates::add(std::uint32_t light, bool ray, float weight, const LaneFloats& expected) {
    lights_.push_back({light, ray, weight});
    LaneFloats& weighted = expected_.emplace_back();
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        weighted.of[i] = expected.of[i] * weight;
        total_.of[i] += weighted.of[i];
    }
}

void LineCandidates::choose(const LaneFloats& steps, const LaneFloats& starts, LineChoices& choices) const {
    constexpr int lanes = ReceiverLanes::width;
    LaneFloats next;  // how far it is to the next step
    for (int i = 0; i < lanes; ++i) {
        choices[std::size_t(i)].clear();
        next.of[i] = starts.of[i] < 1.0f ? starts.of[i] * steps.of[i] : infinity;
    }
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        const LaneFloats& expected = expected_[k];
        // Few lanes connect to a light: whether any does is tested for all at once.
        int reached = 0;
        for (int i = 0; i < lanes; ++i) reached += next.of[i] < expected.of[i] ? 1 : 0;
        for (int i = 0; i < lanes && reached > 0; ++i)
            if (next.of[i] < expected.of[i]) {
                --reached;
                next.of[i] = connect_by_steps(lights_[k], expected.of[i], steps.of[i], next.of[i],
                                              choices[std::size_t(i)]);
            }
        for (int i = 0; i < lanes; ++i) next.of[i] -= expected.of[i];
    }
}

}  // namespace mote::lights
