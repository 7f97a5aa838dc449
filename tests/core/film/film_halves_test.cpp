// The error that the halves of Sobol points state (core/film/film_halves.cpp): as certain as their gain is.
#include <cmath>

#include "core/metrics/relative_error.h"
#include "tests/core/film/steps.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

constexpr int size = 32;
constexpr std::size_t pixels = size * size;
constexpr float constant = 2.0f;

/// Stated squared error less the true one, over its standard error: root mean square over seeds.
double surprise(SamplerKind kind, std::uint32_t passes, std::uint64_t seeds) {
    std::vector<Rgb> truth(pixels);
    for (std::size_t p = 0; p < pixels; ++p) truth[p] = Rgb(constant + step_of(p));
    const RelativeWeights weights = relative_weights(truth, size, size);
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Film film = film_of_steps(size, constant, kind, seed, passes, PassSplit::halves);
        const auto said = film.error();
        REQUIRE(said);
        const double error = relative_error(film.beauty(), truth, weights).error;
        sum +=
            sqr((sqr(said->error) - sqr(error)) / ((sqr(said->high) - sqr(said->error)) / normal_quantile));
    }
    return std::sqrt(sum / double(seeds));
}

}  // namespace

TEST_CASE("The interval of Sobol points in halves is as wide as their noise, not as that of random numbers",
          "[film][halves][gain][statistics]") {
    constexpr std::uint64_t seeds = 200;
    constexpr std::uint32_t passes = 32;
    // The root mean square of 200 normal variables is 1 +- 0.05.
    const double within = 3.0 / std::sqrt(2.0 * double(seeds));
    CHECK(std::fabs(surprise(SamplerKind::independent, passes, seeds) - 1.0) < within);
    // 16 Sobol points for a step have less than a quarter of the variance of random numbers, so that
    // intervals by the latter would be four times as wide, and more. Of the gain less is taken than there is
    // (sobol_gain.h).
    const double of_sobol = surprise(SamplerKind::sobol_halves, passes, seeds);
    CHECK(of_sobol < 1.0 + within);
    CHECK(of_sobol > 0.5);
}
