// Errors of several pictures by one method: what they share, what is noise, and which pixels count.
#include <cmath>
#include <limits>
#include <vector>

#include "core/math/random.h"
#include "core/metrics/series_error.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

using Picture = std::vector<Rgb>;

constexpr int width = 96, height = 64, pixels = width * height;

Picture truth() {
    Picture picture;
    for (int i = 0; i < pixels; ++i)
        picture.push_back((0.5f + float(i % width) / float(width)) * Rgb(1.0f, 0.8f, 0.4f));
    return picture;
}

/// Times a factor of this mean and standard deviation, uniform, independent pixel by pixel.
Picture noisy(const Picture& picture, float mean, float deviation, std::uint64_t seed) {
    Rng rng(seed);
    Picture result;
    for (const Rgb& c : picture)
        result.push_back(c * (mean + deviation * std::sqrt(12.0f) * (rng.next_float() - 0.5f)));
    return result;
}

Picture variance_of(const Picture& picture, float deviation) {
    Picture result;
    for (const Rgb& c : picture) result.push_back(deviation * deviation * c * c);
    return result;
}

std::vector<Picture> one(const Picture& picture) { return {1, picture}; }

ErrorMeasure pair_measure(float deviation, std::span<const std::uint8_t> counted = {}) {
    const Picture r = truth(), a = noisy(r, 1.0f, deviation, 1), b = noisy(r, 1.0f, deviation, 2);
    const Picture v = variance_of(r, deviation);
    return {ReferencePair{a, b, v, v}, width, height, counted};
}

}  // namespace

TEST_CASE("A series separates bias, what pictures share, and noise, free of the references' noise",
          "[metrics][series_error]") {
    std::vector<Picture> images;
    for (std::uint64_t seed = 11; seed < 17; ++seed) images.push_back(noisy(truth(), 1.03f, 0.1f, seed));
    const SeriesError e = pair_measure(0.2f).measure(images);
    CHECK(e.bias == Approx(0.03).margin(0.002));
    CHECK(std::fabs(e.systematic - 0.03) < 3.0 * e.systematic_standard_error);
    CHECK(e.noise == Approx(0.1).epsilon(0.02));
    CHECK(e.error == Approx(std::hypot(0.1, 0.03)).epsilon(0.03));
    CHECK(e.squared_error == Approx(e.error * e.error));
    CHECK(e.bias_standard_error < 0.003);
    CHECK(e.error_standard_error < 0.01);
}

TEST_CASE("One picture of a series has the error that relative_error() finds", "[metrics][series_error]") {
    const Picture r = truth(), a = noisy(r, 1.0f, 0.2f, 1), b = noisy(r, 1.0f, 0.2f, 2);
    const Picture v = variance_of(r, 0.2f), image = noisy(r, 0.9f, 0.1f, 3);
    const ReferencePair pair{a, b, v, v};
    const SeriesError of_pair = ErrorMeasure(pair, width, height).measure(one(image));
    const RelativeError expected = relative_error(image, pair, width, height);
    CHECK(of_pair.error == Approx(expected.error).epsilon(1e-9));
    CHECK(of_pair.bias == Approx(expected.bias).epsilon(1e-9));
    CHECK(of_pair.error_standard_error == Approx(expected.error_standard_error).epsilon(1e-6));
    CHECK(std::isnan(of_pair.systematic));
    CHECK(std::isnan(of_pair.noise));
    CHECK(std::fabs(of_pair.bias + 0.1) < 4.0 * of_pair.bias_standard_error);
    CHECK(of_pair.bias_standard_error < 0.01);

    const SeriesError of_one = ErrorMeasure(a, v, width, height).measure(one(image));
    const RelativeError known = relative_error(image, a, relative_weights(a, v, width, height), {}, v);
    CHECK(of_one.error == Approx(known.error).epsilon(1e-9));
    CHECK(of_one.bias == Approx(known.bias).epsilon(1e-9));
    CHECK(of_one.error < ErrorMeasure(a, {}, width, height).measure(one(image)).error);
}

TEST_CASE("Pixels that do not count change nothing, and need not be finite", "[metrics][series_error]") {
    std::vector<std::uint8_t> left(pixels);
    for (int i = 0; i < pixels; ++i) left[std::size_t(i)] = i % width < width / 2;
    Picture image = noisy(truth(), 1.0f, 0.1f, 5);
    for (int i = 0; i < pixels; ++i)
        if (!left[std::size_t(i)]) image[std::size_t(i)] *= 5.0f;
    const double alone = pair_measure(0.1f, left).measure(one(image)).error;
    CHECK(alone == Approx(0.1).epsilon(0.1));
    CHECK(pair_measure(0.1f).measure(one(image)).error > 1.0);
    for (int i = 0; i < pixels; ++i)
        if (!left[std::size_t(i)]) image[std::size_t(i)] = Rgb(std::numeric_limits<float>::quiet_NaN());
    CHECK(pair_measure(0.1f, left).measure(one(image)).error == alone);

    const std::vector<double> errors = pair_measure(0.1f, left).pixel_errors(image);
    double sum = 0.0;
    for (const double e : errors) sum += e;
    CHECK(sum / (0.5 * pixels) == Approx(alone * alone).epsilon(1e-9));
    CHECK(errors[std::size_t(width) - 1] == 0.0);
}

TEST_CASE("A series refuses sizes that do not fit, and no picture", "[metrics][series_error]") {
    const ErrorMeasure measure = pair_measure(0.1f);
    CHECK_THROWS_AS(measure.measure({}), std::invalid_argument);
    CHECK_THROWS_AS(measure.measure(one(Picture(3))), std::invalid_argument);
    CHECK_THROWS_AS(measure.pixel_errors(Picture(3)), std::invalid_argument);
    CHECK_THROWS_AS(pair_measure(0.1f, std::vector<std::uint8_t>(3)), std::invalid_argument);
    CHECK(std::isnan(ErrorMeasure(Picture(pixels), {}, width, height).measure(one(truth())).error));
}
