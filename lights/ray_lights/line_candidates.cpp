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
    // Points on ray lights are sampled anew each time; a VPL is the same.
    if (light.ray)
        choices.insert(choices.end(), std::size_t(steps), {light.light, true, weight});
    else
        choices.push_back({light.light, false, weight * float(steps)});
    return next;
}

}  // namespace

void LineCandidates::add(std::uint32_t light, bool ray, float weight, const Lanes& expected) {
    lights_.push_back({light, ray, weight});
    Lanes& weighted = expected_.emplace_back();
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        weighted[i] = expected[i] * weight;
        total_[i] += weighted[i];
    }
}

void LineCandidates::choose(const Lanes& steps, const Lanes& starts, LineChoices& choices) const {
    constexpr int lanes = ReceiverLanes::width;
    Lanes next;  // how far it is to the next step
    for (int i = 0; i < lanes; ++i) {
        choices[std::size_t(i)].clear();
        next[i] = starts[i] < 1.0f ? starts[i] * steps[i] : infinity;
    }
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        const Lanes& expected = expected_[k];
        // Few lanes connect to a light: whether any does is tested for all at once.
        int reached = 0;
        for (int i = 0; i < lanes; ++i) reached += next[i] < expected[i] ? 1 : 0;
        for (int i = 0; i < lanes && reached > 0; ++i)
            if (next[i] < expected[i]) {
                --reached;
                next[i] =
                    connect_by_steps(lights_[k], expected[i], steps[i], next[i], choices[std::size_t(i)]);
            }
        for (int i = 0; i < lanes; ++i) next[i] -= expected[i];
    }
}

}  // namespace mote::lights
