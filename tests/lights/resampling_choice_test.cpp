// Resampling: choices in proportion to weights and the mean over candidates, by enumeration of all of them in
// every order.
#include <algorithm>

#include "lights/selection/resampling/resampling_target.h"
#include "lights/selection/resampling/systematic_choice.h"
#include "tests/lights/random_lights.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

using Weights = core::Lanes;
using Choice = lights::SystematicChoice;

/// The mean of visit(choice) over u in [0, 1), exactly: what lane 0 chooses changes where a step falls on
/// the border of a candidate.
template <typename Visit>
void for_each_choice(std::span<const Weights> weights, std::uint32_t n, const Visit& visit) {
    double sum = 0.0, reached = 0.0;
    for (const Weights& w : weights) sum += double(w[0]);
    std::vector<double> borders{0.0, 1.0};
    for (const Weights& w : weights) {
        reached += double(w[0]);
        const double steps = sum > 0.0 ? reached / sum * double(n) : 0.0;
        borders.push_back(steps - std::floor(steps));
    }
    std::sort(borders.begin(), borders.end());
    Choice choice;
    for (std::size_t b = 0; b + 1 < borders.size(); ++b) {
        if (borders[b + 1] - borders[b] < 1e-9) continue;
        core::Lanes u;
        for (float& number : u) number = float(0.5 * (borders[b] + borders[b + 1]));
        choice.choose(weights, n, u);
        visit(choice, borders[b + 1] - borders[b]);
    }
}

}  // namespace

TEST_CASE("Choices have their chances in every order", "[light_selection][resampling]") {
    for (const std::array<float, 3>& values :
         {std::array{1.0f, 2.0f, 5.0f}, std::array{3.0f, 0.0f, 0.25f}, std::array{0.0f, 0.0f, 1.0f}}) {
        std::array<int, 3> order{0, 1, 2};
        do {
            for (const std::uint32_t n : {1u, 2u, 5u}) {
                std::array<Weights, 3> weights{};
                for (std::size_t c = 0; c < 3; ++c) weights[c][0] = values[std::size_t(order[c])];
                std::array<double, 3> mean{};
                for_each_choice(weights, n, [&](const Choice& choice, double probability) {
                    for (const auto& chosen : choice.chosen[0])
                        mean[chosen.candidate] += probability * double(chosen.count);
                    CHECK(choice.chosen[1].empty());
                });
                const double sum = double(values[0] + values[1] + values[2]);
                for (std::size_t c = 0; c < 3; ++c)
                    CHECK(mean[c] == Approx(double(n) * double(weights[c][0]) / sum).margin(1e-6));
            }
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

TEST_CASE("Resampling over three lights, by enumeration", "[light_selection][resampling]") {
    // Two of M = 1, 2, 3 candidates sampled from p; one light may be one that sends nothing.
    Rng rng(5);
    const auto set = random_lights(rng, all_materials(), Lights::plain, 3, 2.0f, 3.0f);
    RandomReceivers receivers(rng, all_materials(), set.lights[0].position, false);
    lights::ReceiverTile tile = receivers.tile;
    const lights::ResamplingTarget target(set, tile, 4.0f, false);
    const auto scratch = std::make_unique<lights::GatherScratch>();
    const std::array<double, 3> p{0.5, 0.3, 0.2};
    int lanes_with_dark_lights = 0;
    for (std::size_t lane = 0; lane < 16; ++lane) {
        std::array<double, 3> f;
        for (std::size_t j = 0; j < 3; ++j) f[j] = sent(set, j, tile, 4.0f)[lane];
        const double right = f[0] + f[1] + f[2];
        if (!(right > 0.0)) continue;
        lanes_with_dark_lights += std::min({f[0], f[1], f[2]}) == 0.0;
        for (int candidates = 1; candidates <= 3; ++candidates) {
            double mean = 0.0, without_m = 0.0;
            const int tuples = int(std::lround(std::pow(3.0, candidates)));
            for (int tuple = 0; tuple < tuples; ++tuple) {  // in every order
                double chance = 1.0;
                std::vector<std::size_t> sampled;
                std::vector<Weights> weights;
                for (int k = 0, rest = tuple; k < candidates; ++k, rest /= 3) {
                    const auto j = std::size_t(rest % 3);
                    chance *= p[j], sampled.push_back(j);
                    core::Lanes values{};
                    Weights& own = weights.emplace_back();
                    own = {};
                    if (target.of_light({j, float(1.0 / (candidates * p[j]))}, 0.0f, *scratch, values))
                        own[0] = values[lane];
                }
                for_each_choice(weights, 1, [&](const Choice& choice, double probability) {
                    for (const auto& chosen : choice.chosen[0]) {
                        const std::size_t j = sampled[chosen.candidate];
                        const double p_hat = double(target.of_lane(int(lane), j).value);
                        mean += chance * probability * choice.sum[0] / p_hat * f[j];
                        without_m += chance * probability * choice.sum[0] * candidates / p_hat * f[j];
                    }
                });
            }
            CHECK(mean == Approx(right).epsilon(1e-5));
            if (candidates > 1) CHECK_FALSE(without_m == Approx(right).epsilon(1e-5));
        }
    }
    CHECK(lanes_with_dark_lights > 2);
}
