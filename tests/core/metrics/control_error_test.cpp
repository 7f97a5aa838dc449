// Control pixels make the interval of a picture's error shorter, and it contains the error as often as
// before.
#include "core/metrics/control_error.h"

#include <cmath>

#include "core/metrics/relative_error.h"
#include "tests/core/metrics/noisy_images.h"
#include "tests/support/catch.h"
#include "tests/support/coverage.h"

using namespace mote::core;
using namespace mote::tests::noisy_images;

namespace {

constexpr int cell = 8;  ///< pixels along an edge

/// Planted faults of control pixels.
enum class Fault { none, noise_is_left_in, of_the_passes, few_pixels };

/// Variance of the mean of four samples by two of them.
Rgb variance_by(const Rgb& one, const Rgb& other) { return (one - other) * (one - other) / 8.0f; }

/// One pixel of each cell. Its four samples have a quarter of a half's variance each.
ControlPixels controls_of(const Image& mu, const Image& a, std::uint64_t seed, Fault fault) {
    constexpr float quieter = 0.5f;
    std::array<Image, 4> samples;
    for (std::size_t i = 0; i < 4; ++i) samples[i] = noisy(mu, hash_keys(seed, i + 1));
    static const std::vector<float> cells(pixels, float(cell * cell)), halved(pixels, 0.5f * cells[0]);
    ControlPixels controls{{}, fault == Fault::few_pixels ? halved : cells};
    Rng rng(hash_keys(seed, 5));
    for (int y = 0; y < height; y += cell)
        for (int x = 0; x < width; x += cell) {
            const Vec2 u = rng.next_vec2();
            const auto p = std::size_t((y + int(u.y * float(cell))) * width + x + int(u.x * float(cell)));
            ControlPixel& c = controls.chosen.emplace_back();
            c.pixel = p;
            std::array<Rgb, 4> own;
            for (std::size_t i = 0; i < 4; ++i) own[i] = mu[p] + quieter * (samples[i][p] - mu[p]);
            c.mean[0] = c.mean[1] = 0.25f * (own[0] + own[1] + own[2] + own[3]);
            c.variance = {variance_by(own[0], own[2]), variance_by(own[1], own[3])};
            if (fault == Fault::noise_is_left_in) c.variance = {};
            if (fault == Fault::of_the_passes) c.mean[1] = a[p];
        }
    return controls;
}

struct Coverage {
    double contained = 0.0;  ///< share of seeds
    double surprise = 0.0;   ///< mean of (stated - true squared error) over its standard error
    double shorter = 0.0;    ///< standard error of the rest over that without controls, on average
};

Coverage coverage(const Filter& filter, std::uint64_t seeds, Fault fault = Fault::none) {
    const Image mu = truth(), variance = variance_of_noise(mu);
    const RelativeWeights weights = relative_weights(mu, width, height);
    Coverage result;
    double differences = 0.0, squares = 0.0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Image a = noisy(mu, 2 * seed), b = noisy(mu, 2 * seed + 1), fa = filter(a), fb = filter(b),
                    picture = mean_of(fa, fb);
        const std::array halves{PictureHalf{a, fa, variance}, PictureHalf{b, fb, variance}};
        const SquaredError of_halves = halves_error(halves, weights, width, height).sum();
        const ControlEstimate of_controls =
            control_estimate(controls_of(mu, a, seed, fault), halves, weights);
        const SquaredError both = with_controls(of_halves, of_controls);
        CHECK(both.variance <= of_halves.variance);
        const PictureError said = error_interval(both);
        const double error = relative_error(picture, mu, weights).error;
        if (error >= said.low && error <= said.high) result.contained += 1.0 / double(seeds);
        // That of the control pixels alone.
        const double difference = both.noise + of_controls.rest - error * error * weights.norm;
        differences += difference, squares += difference * difference;
        result.shorter += std::sqrt(both.variance / of_halves.variance) / double(seeds);
    }
    result.surprise = differences / std::sqrt(squares);
    return result;
}

Image wide(const Image& image) { return boxed(image, 3); }
Image narrow(const Image& image) { return boxed(image, 1); }
Image untouched(const Image& image) { return image; }

constexpr std::uint64_t seeds = 400;

}  // namespace

TEST_CASE("The interval with control pixels contains the error in 95 of 100 seeds at least, and is shorter",
          "[metrics][controls][coverage][statistics]") {
    for (const auto& filter : {untouched, narrow, wide, clamped}) {
        const Coverage c = coverage(filter, seeds);
        CAPTURE(c.contained, c.surprise, c.shorter);
        CHECK(c.contained > 0.95 - 3.0 * std::sqrt(0.95 * 0.05 / double(seeds)));
        CHECK(std::fabs(c.surprise) < 4.0);
        CHECK(c.shorter < 1.0);
    }
    CHECK(coverage(wide, 100).shorter < 0.8);
}

TEST_CASE(
    "Noise of control pixels that counts as error, or that is the passes', and pixels that count for fewer "
    "are found out",
    "[metrics][controls][planted]") {
    CHECK(std::fabs(coverage(narrow, 100, Fault::noise_is_left_in).surprise) > 4.0);
    CHECK(std::fabs(coverage(narrow, 100, Fault::of_the_passes).surprise) > 4.0);
    CHECK(std::fabs(coverage(wide, 100, Fault::few_pixels).surprise) > 4.0);
}

TEST_CASE("Without control pixels the error is that of the halves", "[metrics][controls]") {
    const Image mu = truth(), a = noisy(mu, 1), b = noisy(mu, 2);
    const RelativeWeights weights = relative_weights(mu, width, height);
    const ControlEstimate none = control_estimate({}, {PictureHalf{a, a, a}, PictureHalf{b, b, b}}, weights);
    CHECK(std::isinf(none.variance(1.0)));
    const SquaredError before{1.0, 2.0, 3.0, 4.0}, after = with_controls(before, none);
    CHECK(after.rest == before.rest);
    CHECK(after.variance == before.variance);
    // Two of equal variance are averaged; one that is exact is taken.
    CHECK(with_controls(before, {4.0, 3.0}).rest == Approx(3.0));
    CHECK(with_controls(before, {4.0, 3.0}).variance == Approx(1.5));
    CHECK(with_controls(before, {4.0, 0.0}).rest == 4.0);
    CHECK(with_controls({1.0, 2.0, 0.0, 4.0}, {4.0, 0.0}).rest == 2.0);
    CHECK(with_controls(before, {4.0, 3.0}).noise == before.noise);
    CHECK(with_controls(before, {4.0, 3.0}).norm == before.norm);
}

TEST_CASE("The variance of control pixels depends on the rest, and on what their terms show",
          "[metrics][controls]") {
    // 31 where the rest is 2, of which the terms show twice as much.
    const ControlEstimate of_controls{2.0, 3.0, 4.0, 5.0, 62.0};
    CHECK(of_controls.variance(0.0) == Approx(2.0 * 3.0));
    CHECK(of_controls.variance(2.0) == Approx(62.0));
    CHECK(ControlEstimate{2.0, 3.0, 4.0, 5.0, 6.0}.variance(2.0) == Approx(31.0));
    const SquaredError both = with_controls({0.0, 4.0, 40.0, 1.0}, of_controls);  // of 3: 120
    CHECK(both.rest == Approx(3.5));
    CHECK(both.variance == Approx(30.0));
    CHECK(with_controls({0.0, -4.0, 6.0, 1.0}, of_controls).rest == Approx(-1.0));  // of none: 6
}

TEST_CASE("The interval ends above where the estimate would be low by 1.96 standard errors",
          "[metrics][controls]") {
    const ControlEstimate of_controls{2.0, 4.8, 4.0, 0.05, 0.0};
    const SquaredError both = with_controls({0.0, 2.0, 13.0, 1.0}, of_controls);  // variance of 2: 13
    const PictureError said = error_interval(both);
    const double end = sqr(said.high), deviation = std::sqrt(0.25 * (13.0 + of_controls.variance(end)));
    CHECK(both.rest == Approx(2.0));
    CHECK(end == Approx(2.0 + normal_quantile * deviation).epsilon(0.02));  // by four steps towards it
    CHECK(end > 2.0 + normal_quantile * std::sqrt(both.variance));
    CHECK(with_controls({0.0, 2.0, 13.0, 1.0}, {2.0, 13.0}).more_above == 0.0);
}

TEST_CASE("One control pixel for each pixel, without noise, makes the error exact", "[metrics][controls]") {
    const Image mu = truth(), a = noisy(mu, 1), b = noisy(mu, 2), fa = wide(a), fb = wide(b),
                none(pixels, Rgb(0.0f));
    const RelativeWeights weights = relative_weights(mu, width, height);
    const std::vector<float> ones(pixels, 1.0f);
    ControlPixels controls{{}, ones};
    for (std::size_t p = 0; p < pixels; ++p) controls.chosen.push_back({p, {mu[p], mu[p]}, {}});
    const std::array halves{PictureHalf{a, fa, none}, PictureHalf{b, fb, none}};
    const Image picture = mean_of(fa, fb);
    const double noise = halves_error(halves, weights, width, height).sum().noise;
    const double error = relative_error(picture, mu, weights).error;
    CHECK(noise + control_estimate(controls, halves, weights).rest ==
          Approx(error * error * weights.norm).epsilon(1e-6));
}
