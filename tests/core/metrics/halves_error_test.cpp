// The interval of a picture's error contains the true error as often as it says, whatever the filter is.
#include "core/metrics/halves_error.h"

#include <cmath>
#include <functional>

#include "core/math/random.h"
#include "core/render/stop_clock.h"
#include "tests/core/metrics/noisy_images.h"
#include "tests/support/catch.h"
#include "tests/support/coverage.h"

using namespace mote::core;
using namespace mote::tests::noisy_images;

namespace {

Image same(const Image& image) { return image; }

/// A fifth of the noise is left as it is.
Image mostly_boxed(const Image& image) {
    Image result = boxed(image, 2);
    for (std::size_t p = 0; p < pixels; ++p) result[p] = 0.8f * result[p] + 0.2f * image[p];
    return result;
}

struct Coverage {
    double contained = 0.0;  ///< share of seeds
    double optimist = 0.0;   ///< the same of an interval that ignores bias: around the noise that is left
    double surprise = 0.0;   ///< mean of (stated - true squared error) over its standard error
};

bool contains(const PictureError& interval, double error) {
    return error >= interval.low && error <= interval.high;
}

/// `shared`: share of a half's noise that the other has too; a planted fault.
Coverage coverage(const Filter& filter, std::uint64_t seeds, float shared = 0.0f) {
    const Image mu = truth(), variance = variance_of_noise(mu);
    const RelativeWeights weights = relative_weights(mu, width, height);
    Coverage result;
    double differences = 0.0, squares = 0.0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Image a = noisy(mu, 2 * seed), own = noisy(mu, 2 * seed + 1);
        Image b = own;
        for (std::size_t p = 0; p < pixels; ++p)
            b[p] = mu[p] + std::sqrt(1.0f - shared * shared) * (own[p] - mu[p]) + shared * (a[p] - mu[p]);
        const Image fa = filter(a), fb = filter(b), picture = mean_of(fa, fb);
        const BlockErrors blocks = halves_error({PictureHalf{a, fa, variance}, PictureHalf{b, fb, variance}},
                                                weights, width, height);
        const PictureError said = blocks.of_picture();
        const double error = relative_error(picture, mu, weights).error;
        BlockErrors without_bias = blocks;
        for (double& rest : without_bias.rest) rest = 0.0;
        if (contains(said, error)) result.contained += 1.0 / double(seeds);
        if (contains(without_bias.of_picture(), error)) result.optimist += 1.0 / double(seeds);
        double sum = 0.0;
        for (std::size_t i = 0; i < blocks.rest.size(); ++i) sum += blocks.noise[i] + blocks.rest[i];
        const double difference = sum - error * error * weights.norm;
        differences += difference, squares += difference * difference;
    }
    result.surprise = differences / std::sqrt(squares);
    return result;
}

/// The noise of passes, four times that of noisy(), summed up to a test of a rule.
struct Passes {
    static constexpr float loud = 4.0f;
    Image a{pixels, Rgb(0.0f)}, b{pixels, Rgb(0.0f)};  ///< of the two halves
    std::uint32_t count = 0;                           ///< of both together

    void add(const Image& mu, std::uint32_t until, std::uint64_t seed) {
        const float size = loud * std::sqrt(0.5f * float(until - count));
        for (Image* half : {&a, &b}) {
            const Image noise = noisy(mu, hash_keys(seed, until, half == &b));
            for (std::size_t p = 0; p < pixels; ++p) (*half)[p] += size * (noise[p] - mu[p]);
        }
        count = until;
    }
    Image mean(const Image& mu, const Image& noise) const {
        Image result(pixels);
        for (std::size_t p = 0; p < pixels; ++p) result[p] = mu[p] + noise[p] / (0.5f * float(count));
        return result;
    }
};

/// Shares of renders that a limit on an end of the interval has ended although their error is above it.
struct Broken {
    double by_interval = 0.0;  ///< limit on the upper end of an interval that is evaluated once
    double by_rule = 0.0;      ///< limit on PictureError::rule_high
};

/// Tests by the render driver, with a filter whose bias is just above the limit: no render should end.
Broken broken_limits(std::uint64_t seeds) {
    constexpr std::uint32_t last = 512;
    const Image mu = truth();
    const RelativeWeights weights = relative_weights(mu, width, height);
    const double limit = 0.97 * relative_error(boxed(mu, 2), mu, weights).error;
    Broken broken;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        Passes passes;
        bool by_interval = false, by_rule = false;
        for (std::uint32_t n = noise_rule_from; n <= last && !(by_interval && by_rule); ++n) {
            if (!filtered_noise_is_due(n)) continue;
            passes.add(mu, n, seed);
            const Image a = passes.mean(mu, passes.a), b = passes.mean(mu, passes.b), fa = boxed(a, 2),
                        fb = boxed(b, 2);
            Image picture(pixels), variance(pixels);
            for (std::size_t p = 0; p < pixels; ++p) {
                picture[p] = 0.5f * (fa[p] + fb[p]);
                variance[p] = sqr(Passes::loud * deviation(p)) * mu[p] * mu[p] / (0.5f * float(n));
            }
            SquaredError said = halves_error({PictureHalf{a, fa, variance}, PictureHalf{b, fb, variance}},
                                             weights, width, height)
                                    .sum();
            by_rule |= error_interval(said).rule_high <= limit;
            said.lowest_rest = -std::numeric_limits<double>::infinity();  // the rest is as low as it seems
            by_interval |= error_interval(said).high <= limit;
        }
        broken.by_interval += by_interval ? 1.0 / double(seeds) : 0.0;
        broken.by_rule += by_rule ? 1.0 / double(seeds) : 0.0;
    }
    return broken;
}

constexpr std::uint64_t seeds = 600;

}  // namespace

TEST_CASE("The interval of a filtered picture contains its error in 95 of 100 seeds",
          "[metrics][halves][coverage][statistics]") {
    const Filter filters[] = {same, [](const Image& i) { return boxed(i, 1); },
                              [](const Image& i) { return boxed(i, 3); }, clamped, mostly_boxed};
    for (const Filter& filter : filters) {
        CAPTURE(&filter - filters);
        const Coverage c = coverage(filter, seeds);
        mote::tests::check_coverage(c.contained, seeds);
        CHECK(std::fabs(c.surprise) < 4.0);
    }
}

TEST_CASE("A rule that is evaluated again and again breaks its limit in 5 of 100 renders at most",
          "[metrics][halves][coverage][statistics]") {
    constexpr std::uint64_t renders = 200;
    const double deviation_of_share = std::sqrt(0.05 * 0.95 / double(renders));
    const Broken broken = broken_limits(renders);
    CHECK(broken.by_rule < 0.05 + 3.0 * deviation_of_share);
    // Planted: by the intervals themselves, of which the lowest counts.
    CHECK(broken.by_interval > 0.05 + 3.0 * deviation_of_share);
}

TEST_CASE("An interval that ignores bias is found out", "[metrics][halves][coverage][planted]") {
    CHECK(coverage([](const Image& i) { return boxed(i, 3); }, 100).optimist < 0.05);
}

TEST_CASE("Noise in the weights widens the interval", "[metrics][halves][statistics]") {
    const Image mu = truth(), none(pixels, Rgb(0.0f));
    const RelativeWeights exact = relative_weights(mu, width, height);
    // Both halves are off by 1/10; the light of one is known with noise, so a block's sum is as well.
    Image off(pixels);
    for (std::size_t p = 0; p < pixels; ++p) off[p] = 1.1f * mu[p];
    const std::array halves{PictureHalf{mu, off, none}, PictureHalf{mu, off, none}};
    const auto with = [&](const RelativeWeights& a, const RelativeWeights& b) {
        BlockErrors blocks = halves_error(halves, exact, width, height);
        add_variance_of_weights(blocks, halves, {a, b}, width);
        return blocks;
    };
    const BlockErrors same_weights = with(exact, exact);
    for (const double variance : same_weights.variance) CHECK(variance == 0.0);
    // The sum of a block is sum w 0.01 |mu|^2 by either weights; half of its difference is its standard
    // error.
    const RelativeWeights other = relative_weights(noisy(mu, 1), width, height);
    const BlockErrors blocks = with(exact, other);
    std::vector<double> differences(blocks.variance.size(), 0.0);
    for (std::size_t p = 0; p < pixels; ++p)
        differences[blocks.index_of(p, width)] +=
            0.01 * mean_square(mu[p]) * (exact.weight[p] / exact.norm - other.weight[p] / other.norm) *
            exact.norm;
    for (std::size_t i = 0; i < differences.size(); ++i)
        CHECK(blocks.variance[i] == Approx(0.25 * differences[i] * differences[i]).epsilon(1e-3));
    CHECK(blocks.of_picture().high > same_weights.of_picture().high);
}

TEST_CASE("An interval ends nowhere below the noise that is known", "[metrics][halves]") {
    const Image mu = truth(), a = noisy(mu, 1), b = noisy(mu, 2), f = boxed(a, 1), g = boxed(b, 1),
                none(pixels, Rgb(0.0f));
    const RelativeWeights weights = relative_weights(mu, width, height);
    BlockErrors blocks =
        halves_error({PictureHalf{a, f, none}, PictureHalf{b, g, none}}, weights, width, height);
    for (double& rest : blocks.rest) rest = -1e6;
    double noise = 0.0;
    for (const double of_block : blocks.noise) noise += of_block;
    CHECK(noise > 0.0);
    CHECK(blocks.of_picture().high == Approx(std::sqrt(noise / blocks.sum().norm)));
    CHECK(blocks.of_picture().error == blocks.of_picture().high);
}

TEST_CASE("Halves that share noise are found out", "[metrics][halves][coverage][planted]") {
    CHECK(coverage([](const Image& i) { return boxed(i, 1); }, 100, 0.3f).contained < 0.8);
}

TEST_CASE("The error of a picture without noise is that of its filter", "[metrics][halves]") {
    const Image mu = truth(), f = boxed(mu, 2), none(pixels, Rgb(0.0f));
    const RelativeWeights weights = relative_weights(mu, width, height);
    const BlockErrors blocks =
        halves_error({PictureHalf{mu, f, none}, PictureHalf{mu, f, none}}, weights, width, height);
    const double error = relative_error(f, mu, weights).error;
    CHECK(blocks.of_picture().error == Approx(error).epsilon(1e-6));
    CHECK(blocks.of_picture().low == Approx(error).epsilon(1e-6));
    CHECK(blocks.of_picture().high == Approx(error).epsilon(1e-6));
    CHECK(blocks.of_block(0).error < 0.5 * blocks.of_block(2).error);  // smooth, and stripes
    CHECK_THROWS_AS(
        halves_error({PictureHalf{mu, f, none}, PictureHalf{mu, {}, none}}, weights, width, height),
        std::invalid_argument);
}

TEST_CASE("A black picture has no relative error", "[metrics][halves]") {
    const Image black(pixels, Rgb(0.0f));
    const BlockErrors blocks =
        halves_error({PictureHalf{black, black, black}, PictureHalf{black, black, black}},
                     relative_weights(black, width, height), width, height);
    CHECK(std::isinf(blocks.of_picture().high));
}
