// Resampling: a few of many weighted candidates, in proportion to what they are thought to send
// (Talbot et al. 2005; Bitterli et al. 2020, Sec. 2).
//
// Candidates y_c come with weights w_c, such that the sum of w_c g(y_c) is right in the mean for every
// function g. Each gets v_c = w_c p_hat(y_c), and n are chosen with chance v_c / S, where S is the sum of all
// v_c. What is chosen counts  W = S / (n p_hat(y)) , so that the mean over all choices of  W f(y)  is the sum
// of w_c f(y_c): right wherever p_hat is 0 only where f is. With M candidates sampled from p, w_c = 1 / (M p)
// and n = 1 this is W = (1 / p_hat) (1/M) sum of p_hat / p (Bitterli et al. 2020, Eq. 6).
//
// All candidates are at hand, so instead of n reservoirs, each with a random number a candidate, one number u
// places n even steps in S: n choices with less variance, for sixteen receivers at once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/lanes.h"

namespace mote::lights {

/// A candidate, and how many of the n choices fell on it.
struct ChosenCandidate {
    std::uint32_t candidate, count;
};

/// For every lane its choices, in the order of the candidates, and S. Lanes whose weights are all 0 choose
/// nothing. u in [0, 1). Weights are finite and not negative.
struct SystematicChoice {
    static constexpr std::size_t width = core::Lanes::width;
    std::array<std::vector<ChosenCandidate>, width> chosen;
    std::array<double, width> sum{};

    void choose(std::span<const core::Lanes> weights, std::uint32_t n, const core::Lanes& u) {
        for (auto& lane : chosen) lane.clear();
        sum = {};
        for (const auto& w : weights)
            for (std::size_t i = 0; i < width; ++i) sum[i] += double(w[i]);
        std::array<double, width> reached{}, next, step;
        std::array<std::uint32_t, width> taken{};
        for (std::size_t i = 0; i < width; ++i)
            step[i] = sum[i] / double(n), next[i] = double(u[i]) * step[i];
        for (std::size_t c = 0; c < weights.size(); ++c) {
            bool any = false;
            for (std::size_t i = 0; i < width; ++i) {
                reached[i] += double(weights[c][i]);
                any |= reached[i] > next[i];
            }
            if (!any) continue;
            for (std::size_t i = 0; i < width; ++i) {
                const std::uint32_t before = taken[i];
                while (taken[i] < n && reached[i] > next[i])
                    next[i] = (double(++taken[i]) + double(u[i])) * step[i];
                if (taken[i] > before) chosen[i].push_back({std::uint32_t(c), taken[i] - before});
            }
        }
    }
};

}  // namespace mote::lights
