// Weights from halves of the passes are those of the light, whatever its noise.
#include "core/metrics/halves_weights.h"

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

constexpr int width = 64, height = 48;
constexpr std::size_t pixels = std::size_t(width) * std::size_t(height);

/// Light 1 in every pixel, with uniform noise of the same standard deviation.
std::vector<Rgb> noisy(std::uint64_t seed, float deviation) {
    std::vector<Rgb> image(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
        Rng rng(hash_keys(seed, p));
        image[p] = Rgb(1.0f + deviation * std::sqrt(12.0f) * (rng.next_float() - 0.5f));
    }
    return image;
}

/// Noise of their mean, sum w s^2 / sum w |r|^2 relative to what it is.
double stated_over_true(const RelativeWeights& weights) {
    double sum = 0.0;
    for (const double w : weights.weight) sum += w;
    return sum / weights.noise_norm;
}

}  // namespace

TEST_CASE("Weights do not take noise for light", "[metrics][halves][statistics]") {
    const std::vector<Rgb> a = noisy(1, 0.5f), b = noisy(2, 0.5f);
    // The mean square of the halves' mean is 1 + 0.5^2 / 2; the median of 25 products of skewed values lies
    // below their mean of 1, and the weights are larger where it is.
    CHECK(stated_over_true(weights_of_halves(a, b, width, height)) > 1.0);
    CHECK(stated_over_true(weights_of_halves(a, b, width, height)) < 1.2);
    CHECK(stated_over_true(weights_of_halves(noisy(1, 0.0f), noisy(2, 0.0f), width, height)) ==
          Approx(1.0).epsilon(1e-6));
}

TEST_CASE("A lamp that one half has missed is dark, one that both have is bright", "[metrics][halves]") {
    std::vector<Rgb> a = noisy(1, 0.0f), b = a;
    a[2000] = Rgb(100.0f), a[700] = b[700] = Rgb(100.0f);
    const RelativeWeights weights = weights_of_halves(a, b, width, height);
    CHECK(weights.weight[2000] == weights.weight[0]);
    CHECK(weights.weight[700] < 1e-3 * weights.weight[0]);
    CHECK_THROWS_AS(weights_of_halves(a, {}, width, height), std::invalid_argument);
}
