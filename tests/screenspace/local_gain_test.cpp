// Gain of passes that are points of a sequence: powers of their number, independent ones, and both side by
// side.
#include "screenspace/denoising/local_gain.h"

#include <cmath>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::screenspace;

namespace {

constexpr int width = 96, height = 64;

/// Difference squared of sums over the halves of blocks of 2^level points, for R[k] = rate^k: normal.
std::vector<float> squares(std::uint32_t level, float rate, std::uint64_t seed) {
    const double variance =
        std::exp2(double(level)) * std::pow(double(rate), level - 1.0) * (2.0 - double(rate));
    std::vector<float> result;
    for (std::size_t p = 0; p < std::size_t(width * height); ++p) {
        Rng rng(hash_keys(seed, p));
        const double u = 1.0 - double(rng.next_float()), v = double(rng.next_float());
        const double normal = std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * pi * v);
        result.push_back(float(variance * normal * normal));
    }
    return result;
}

double mean(const std::vector<float>& values, int from, int to) {
    double sum = 0.0;
    for (int y = 0; y < height; ++y)
        for (int x = from; x < to; ++x) sum += double(values[std::size_t(y * width + x)]);
    return sum / double(height * (to - from));
}

}  // namespace

TEST_CASE("The gain of a ratio is that of a power of the number of points but for the last doubling",
          "[gain]") {
    for (const std::uint32_t level : {2u, 3u, 6u, 10u})
        for (const float r : {1.0f, 0.9f, 0.5f, 0.25f}) {
            const float q = std::pow(r, float(level) - 1.0f) * (2.0f - r), last = std::sqrt(r);
            INFO(level << " " << r);
            // R[K-1], half of R[K] in the difference and all of it in the mean.
            const float half = std::pow(r, float(level) - 1.0f) * (2.0f - r) / (2.0f - last);
            // At level 2 and r = 1 the slope of Eq. (1) is 0: r is known to the root of a float's precision.
            CHECK(gain_of_ratio(q, level) == Approx(half * last).epsilon(1e-3));
            CHECK(gain_of_ratio(q, level) >= 0.999f * std::pow(r, float(level)));
        }
    CHECK(gain_of_ratio(1.0f, 6) == Approx(1.0f));
    for (const std::uint32_t level : {2u, 6u})
        for (float q = 0.05f; q < 1.0f; q += 0.05f)
            CHECK(gain_of_ratio(q, level) < gain_of_ratio(q + 0.05f, level));
}

TEST_CASE("Gains are those of the window", "[gain]") {
    constexpr std::uint32_t level = 6;
    const std::vector<float> edges = squares(level, 0.5f, 1), independent = squares(level, 1.0f, 2);
    std::vector<float> seen, expected(std::size_t(width * height), std::exp2(float(level)));
    std::vector<Rgb> light(std::size_t(width * height), Rgb(0.5f));
    for (std::size_t p = 0; p < light.size(); ++p)
        seen.push_back(int(p) % width < width / 2 ? edges[p] : independent[p]);
    const std::vector<float> gain = local_gain(width, height, light, {seen, expected}, level);
    // Some 20 windows without a common pixel lie on each side; what is sought in one is known to sqrt(2 /
    // 121).
    const float of_edges = gain_of_ratio(std::pow(0.5f, 5.0f) * 1.5f, level);
    CHECK(mean(gain, 0, width / 2 - 6) == Approx(double(of_edges)).epsilon(3.0 * 0.13 / std::sqrt(20.0)));
    // At most 1, so that the noise of a ratio lowers it: by sqrt(2 / 121) / sqrt(2 pi) of r^K, about.
    CHECK(mean(gain, width / 2 + 6, width) > 0.85);
    CHECK(mean(gain, width / 2 + 6, width) <= 1.0);

    // Light and its noise in another unit, and twice as bright on one side.
    for (std::size_t p = 0; p < light.size(); ++p) {
        const float unit = int(p) % width < width / 3 ? 8.0f : 4.0f;
        light[p] *= unit, seen[p] *= unit * unit, expected[p] *= unit * unit;
    }
    const std::vector<float> again = local_gain(width, height, light, {seen, expected}, level);
    // A pixel's scale depends on a window around it, and a gain the scales of its window.
    for (std::size_t p = 0; p < light.size(); ++p)
        if (std::abs(int(p) % width - width / 3) > 11) REQUIRE(again[p] == Approx(gain[p]).epsilon(1e-4));
}

TEST_CASE("Without differences, light or finite values a gain is 1", "[gain]") {
    const std::vector<Rgb> light(std::size_t(width * height), Rgb(1.0f)), black(light.size(), Rgb(0.0f));
    std::vector<float> none(light.size(), 0.0f), some(light.size(), 1.0f);
    for (const float g : local_gain(width, height, light, {none, some}, 6)) REQUIRE(g == 1.0f);
    for (const float g : local_gain(width, height, black, {some, some}, 6)) REQUIRE(g == 1.0f);
    for (const float g : local_gain(width, height, light, {some, std::vector<float>(light.size(), 9.0f)}, 3))
        REQUIRE(g == 1.0f);  // too few points
    std::vector<float> wrong = some;
    wrong[1000] = INFINITY;
    for (const float g : local_gain(width, height, light, {wrong, some}, 6)) REQUIRE(g == Approx(1.0f));
    CHECK_THROWS_AS(local_gain(width, height + 1, light, {some, some}, 6), std::invalid_argument);
}
