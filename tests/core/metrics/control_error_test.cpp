// The interval from control passes contains the true error as often as it says, whatever the image is:
// biased, and with noise that pixels share.
#include "core/metrics/control_error.h"

#include <cmath>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

constexpr int width = 64, height = 48;
constexpr std::size_t pixels = std::size_t(width) * std::size_t(height);
using Image = std::vector<Rgb>;

float normal(Rng& rng) {
    const float u = std::sqrt(-2.0f * std::log(1.0f - rng.next_float()));
    return u * std::cos(6.2831853f * rng.next_float());
}

/// Light over two orders of magnitude.
Image truth() {
    Image image(pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        image[p] = std::exp(4.6f * float(p / width) / float(height)) * Rgb(1.0f, 0.8f, 0.6f);
    return image;
}

/// What a bound removes at the borders, and splotches that neighbours share.
Image biased(const Image& mu, std::uint64_t seed, float removed) {
    Image image(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
        const auto x = int(p % width), y = int(p / width);
        const float border = std::exp(-float(std::min({x, y, width - 1 - x, height - 1 - y})) / 8.0f);
        Rng splotch(hash_keys(seed, x / 8, y / 8));
        image[p] = mu[p] * (1.0f - removed * border) * (1.0f + 0.1f * normal(splotch));
    }
    return image;
}

/// One pixel of each block, with a standard deviation of a half of 60 %.
/// `follows`: the share of the image's own error that the control passes have as well; a planted fault.
ControlSamples sampled(const Image& mu, const Image& image, std::uint64_t seed, float follows) {
    ControlSamples samples{width / control_block_width, height / control_block_height, {}};
    for (int row = 0; row < samples.rows; ++row)
        for (int column = 0; column < samples.columns; ++column) {
            Rng rng(hash_keys(seed, row, column));
            const int x = 4 * column + int(rng.next_float() * 4.0f),
                      y = 2 * row + int(rng.next_float() * 2.0f);
            const auto p = std::size_t(y * width + x);
            const Rgb mean = mu[p] + follows * (image[p] - mu[p]);
            const float a = 1.0f + 0.6f * normal(rng), b = 1.0f + 0.6f * normal(rng);
            samples.blocks.push_back({p, 8.0, a * mean, b * mean});
        }
    return samples;
}

PictureError stated(const Image& image, const ControlSamples& samples) {
    RelativeWeights weights = relative_weights(image);
    weights.noise_norm = weights.norm;
    return control_error(image, control_weights(image, weights, samples, width), samples);
}

/// The light of one pixel of each block, times `a` and `b`.
ControlSamples exact(const Image& mu, float a = 1.0f, float b = 1.0f) {
    ControlSamples samples{width / control_block_width, height / control_block_height, {}};
    for (int row = 0; row < samples.rows; ++row)
        for (int column = 0; column < samples.columns; ++column) {
            const auto p = std::size_t(2 * row * width + 4 * column);
            samples.blocks.push_back({p, 8.0, a * mu[p], b * mu[p]});
        }
    return samples;
}

struct Coverage {
    double contained = 0.0, above = 0.0;  ///< shares of seeds: within, and above the upper end
};

Coverage coverage(float removed, std::uint64_t seeds, float follows = 0.0f) {
    const Image mu = truth();
    Coverage result;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Image image = biased(mu, seed, removed);
        const double error = relative_error(image, mu, relative_weights(mu)).error;
        const PictureError said = stated(image, sampled(mu, image, hash_keys(seed, 1), follows));
        const double share = 1.0 / double(seeds);
        if (error >= said.low && error <= said.high) result.contained += share;
        if (error > said.high) result.above += share;
    }
    return result;
}

}  // namespace

TEST_CASE("The interval from control passes contains the error of a biased image in 95 of 100 seeds",
          "[metrics][control][coverage][statistics]") {
    constexpr std::uint64_t seeds = 600;
    const double within = 3.0 * std::sqrt(0.95 * 0.05 / double(seeds));
    for (const float removed : {0.0f, 0.15f, 0.3f}) {
        CAPTURE(removed);
        const Coverage c = coverage(removed, seeds);
        CHECK(c.contained > 0.95 - within);
        CHECK(c.contained < 0.95 + within);
    }
}

TEST_CASE("The error of an image that misses most light of narrow places is not stated too low",
          "[metrics][control][coverage][statistics]") {
    // Light of the blocks around says less than it is worth there, so the weights are too large.
    CHECK(coverage(0.8f, 200).above < 0.05);
}

TEST_CASE("Control passes that err as the image does are found out", "[metrics][control][planted]") {
    CHECK(coverage(0.8f, 100, 1.0f).above > 0.95);
}

TEST_CASE("An image that is off by a factor has that error, and an interval without width",
          "[metrics][control]") {
    const Image mu = truth();
    Image half = mu;
    for (Rgb& light : half) light *= 0.5f;
    const PictureError said = stated(half, exact(mu));
    // Every pixel is half as bright as its light; sampled pixels have the weights of their blocks nearly.
    CHECK(said.error == Approx(0.5).epsilon(0.01));
    CHECK(said.low <= said.error);
    CHECK(said.high >= said.error);
    CHECK(said.rule_high == said.high);
}

TEST_CASE("Few samples, and a black image, have no error from control passes", "[metrics][control]") {
    const Image mu = truth(), black(pixels, Rgb(0.0f));
    ControlSamples samples = exact(mu);
    samples.columns = int(min_control_samples) - 1, samples.rows = 1;
    samples.blocks.resize(min_control_samples - 1);
    const RelativeWeights weights{std::vector<double>(pixels, 1.0), 1.0, 1.0};
    CHECK(std::isinf(control_error(mu, weights, samples).high));
    samples.blocks.push_back(samples.blocks.back()), ++samples.columns;
    CHECK(std::isfinite(control_error(mu, weights, samples).high));
    CHECK(std::isinf(stated(black, exact(mu)).high));
}

TEST_CASE("An upper end is never zero", "[metrics][control]") {
    const Image mu = truth();
    const PictureError said = stated(mu, exact(mu, 1.1f, 0.9f));  // halves that err in opposite directions
    CHECK(said.error == 0.0);
    CHECK(said.high > 0.0);
}
