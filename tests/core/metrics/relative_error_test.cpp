// The one measure of errors and noise: its identities, the reference's noise, and what a film says of its
// own.
#include <cmath>
#include <vector>

#include "core/film/film.h"
#include "core/math/random.h"
#include "core/metrics/reference_pair.h"
#include "core/metrics/relative_error.h"
#include "core/metrics/series_error.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

using Picture = std::vector<Rgb>;

constexpr int width = 24, height = 18, pixels = width * height;

/// Light that grows by a factor of fifty from left to right, black in the lowest quarter, and a lamp of four
/// pixels.
Picture scene_picture(float scale = 1.0f, float lamp = 1000.0f) {
    Picture picture;
    for (int i = 0; i < pixels; ++i) {
        const float level =
            i >= pixels * 3 / 4 ? 0.0f : std::exp(4.0f * float(i % width) / float(width) - 2.0f);
        picture.push_back(scale * level * Rgb(1.0f, 0.8f, 0.4f));
    }
    for (const int i : {100, 101, 124, 125}) picture[std::size_t(i)] = Rgb(scale * lamp);
    return picture;
}

RelativeError error_of(const Picture& image, const Picture& reference) {
    return relative_error(image, reference, relative_weights(reference, width, height));
}

double normal(Rng& rng) {
    return std::sqrt(-2.0 * std::log(1.0 - double(rng.next_float()))) *
           std::cos(2.0 * 3.14159265358979 * double(rng.next_float()));
}

const std::vector<Layer> layers = {{"all", ""}};

/// Passes of the picture, each value times one that is 1 on average: exponentially distributed, or stratified
/// over every block of sixteen passes.
Film noisy_film(const Picture& truth, std::uint32_t passes, std::uint64_t seed, bool stratified) {
    Film film(width, height, layers);
    std::vector<double> shift;
    for (std::uint32_t i = 0; i < passes; ++i) {
        PassImage image(width, height, 1);
        Rng rng(hash_keys(seed, i));
        for (int p = 0; p < pixels; ++p) {
            const bool is_lamp = truth[std::size_t(p)].x > 500.0f;
            double u = double(rng.next_float());
            if (stratified) u = (double((i + std::uint32_t(p)) % 16) + u) / 16.0;
            const double factor = is_lamp ? 1.0 : -std::log(1.0 - u * (1.0 - 1e-7));
            image.layer(0)[std::size_t(p)] = float(factor) * truth[std::size_t(p)];
        }
        film.add_pass(image);
    }
    return film;
}

}  // namespace

TEST_CASE("A picture that is 1 + b times its reference has the bias b and the error |b|", "[relative]") {
    const Picture reference = scene_picture();
    for (const float b : {0.25f, -0.5f, 0.03125f}) {
        Picture image = reference;
        for (Rgb& p : image) p *= 1.0f + b;
        const RelativeError e = error_of(image, reference);
        CHECK(e.bias == Approx(b).epsilon(1e-6));
        CHECK(e.error == Approx(std::abs(b)).epsilon(1e-6));
    }
}

TEST_CASE("An error is never below the bias that it contains", "[relative]") {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const Picture reference = scene_picture();
        Picture image = reference;
        Rng rng(seed);
        for (Rgb& p : image) p *= 0.9f + 0.3f * rng.next_float();
        const RelativeError e = error_of(image, reference);
        CHECK(e.error >= std::abs(e.bias));
        CHECK(std::abs(e.bias) > 0.01);
        // Nor is it where the noise of the reference would take more away than there is.
        const Picture large(reference.size(), Rgb(1e6f));
        const RelativeError noisy =
            relative_error(image, reference, relative_weights(reference, width, height), {}, large);
        CHECK(noisy.error >= std::abs(noisy.bias));
    }
}

TEST_CASE("The error has no scale, and a pixel of a lamp counts for four at most", "[relative]") {
    const auto noisy = [](Picture image) {
        for (std::size_t i = 0; i < image.size(); ++i)
            if (image[i].x < 500.0f) image[i] *= i % 2 ? 1.25f : 0.75f;
        return image;
    };
    const Picture one = scene_picture(), bright = scene_picture(1e6f, 1.0f);
    const double error = error_of(noisy(scene_picture(1.0f, 400.0f)), scene_picture(1.0f, 400.0f)).error;
    CHECK(error > 0.2);
    // The lamp is exact, the relative error of all others is a quarter.
    const RelativeWeights weights = relative_weights(one, width, height);
    double of_lamp = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const double counts = weights.weight[i] * mean_square(glm::dvec3(one[i]));
        CHECK(counts <= 4.0);
        if (one[i].x > 500.0f) of_lamp += counts;
    }
    CHECK(of_lamp < 0.08 * weights.norm);
    CHECK(error_of(noisy(one), one).error ==
          Approx(0.25 * std::sqrt(1.0 - of_lamp / weights.norm)).epsilon(1e-5));
    const Picture faint = scene_picture(1e-6f, 400.0f);
    CHECK(error_of(noisy(faint), faint).error == Approx(error).epsilon(1e-3));
    // Counterexample: in an error relative to the mean, the lamp hides the noise of everything else.
    double squares = 0.0, mean = 0.0;
    const Picture image = noisy(one);
    for (std::size_t i = 0; i < one.size(); ++i)
        squares += mean_square(glm::dvec3(image[i]) - glm::dvec3(one[i])) / pixels, mean += one[i].y / pixels;
    CHECK(std::sqrt(squares) / mean < 0.2 * error);
    // Nothing to be relative to.
    CHECK(std::isnan(error_of(one, Picture(one.size(), Rgb(0.0f))).error));
}

TEST_CASE("A reference of 4 % judges an error of 1 %, and says how well", "[relative][statistics]") {
    const Picture truth = scene_picture();
    Picture image = truth;
    Rng image_rng(77);
    for (Rgb& p : image) p *= float(1.0 + 0.01 * normal(image_rng));
    const double exact = error_of(image, truth).error;
    REQUIRE(exact == Approx(0.01).epsilon(0.15));
    double z_squares = 0.0, raw = 0.0;
    const int n = 300;
    for (int seed = 0; seed < n; ++seed) {
        Picture reference = truth, variance = truth;
        Rng rng(hash_keys(5, std::uint64_t(seed)));
        for (std::size_t i = 0; i < truth.size(); ++i) {
            reference[i] *= float(1.0 + 0.04 * normal(rng));
            variance[i] = 0.0016f * truth[i] * truth[i];
        }
        const RelativeWeights weights = relative_weights(reference, variance, width, height);
        const RelativeError e = relative_error(image, reference, weights, {}, variance);
        raw += relative_error(image, reference, weights).error / n;
        // The error's square is what is near to normal.
        const double s =
            (e.error + e.error_standard_error) * (e.error + e.error_standard_error) - e.error * e.error;
        const double difference = e.error * e.error - exact * exact;
        z_squares += difference * difference / (s * s) / n;
    }
    CHECK(raw > 0.035);  // without subtracting, the reference is all that one sees
    // Scores that are not normal to the last: below zero they are cut, so their squares are below 1 on
    // average; 1 + 4 standard deviations of the mean of 300 squares of normal ones bound it from above. Cut
    // where error^2 is 0, at -0.8 s, they have 0.69; and 4 D^2 v is taken from |d|^2 where that is above v,
    // which doubles s^2 where noise is nearly all there is: 0.35, with a spread of 0.75 and so 0.044 for the
    // mean.
    CHECK(z_squares < 1.0 + 4.0 * std::sqrt(2.0 / n));
    CHECK(z_squares > 0.35 - 4.0 * 0.044);
}

TEST_CASE("Two noisy references add nothing to a bias", "[relative][statistics]") {
    // The picture is 2 % too bright; references have a noise of 20 %, in which 4 % of bias hide with one of
    // them.
    const Picture truth = scene_picture();
    Picture image = truth, variance = truth;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        image[i] *= 1.02f;
        variance[i] = truth[i].x < 500.0f ? 0.04f * truth[i] * truth[i] : Rgb(0.0f);
    }
    const int n = 400;
    double one = 0.0, two = 0.0, squares = 0.0;
    for (int seed = 0; seed < n; ++seed) {
        Picture a = truth, b = truth;
        Rng rng(hash_keys(6, std::uint64_t(seed)));
        for (std::size_t i = 0; i < truth.size(); ++i) {
            if (truth[i].x >= 500.0f) continue;  // a lamp that is seen has no noise
            a[i] *= float(1.0 + 0.2 * normal(rng));
            b[i] *= float(1.0 + 0.2 * normal(rng));
        }
        one += relative_error(image, a, relative_weights(truth, width, height), {}, variance).bias / n;
        const double e = relative_error(image, {a, b, variance, variance}, width, height).bias;
        two += e / n, squares += e * e / n;
    }
    const double error = std::sqrt((squares - two * two) / n);
    INFO("one " << one << ", two " << two << " +- " << error);
    CHECK(one < 0.0);
    CHECK(error < 0.001);  // a fortieth of the 4 %
    CHECK(std::abs(two - 0.02) < 4.0 * error);
}

TEST_CASE("Two references of 40 % without variances judge an error of 5 %", "[relative][statistics]") {
    const Picture truth = scene_picture();
    Picture image = truth;
    Rng image_rng(78);
    for (Rgb& p : image) p *= float(1.01 + 0.05 * normal(image_rng));
    const int n = 600;
    const double exact = error_of(image, truth).error;
    double mean = 0.0, squares = 0.0, variances = 0.0;
    for (int seed = 0; seed < n; ++seed) {
        Picture a = truth, b = truth;
        Rng rng(hash_keys(7, std::uint64_t(seed)));
        for (Picture* r : {&a, &b})
            for (Rgb& p : *r)
                // An exponential value, mostly less than the truth and sometimes twice as much: variance
                // 0.16. A lamp that is seen has no noise.
                if (p.x < 500.0f) p *= 0.6f - 0.4f * std::log(1.0f - rng.next_float());
        // Its square may be below 0: cut there, or at the bias, its mean would be twice as large.
        const SeriesError e =
            ErrorMeasure(ReferencePair{a, b, {}, {}}, width, height).measure(std::vector<Picture>{image});
        mean += e.squared_error / n, squares += e.squared_error * e.squared_error / n;
        variances += sqr(sqr(e.error + e.error_standard_error) - sqr(e.error)) / n;
    }
    const double variance = squares - mean * mean;
    INFO("exact " << exact << ", square " << mean << " +- " << std::sqrt(variance / n) << ", spread "
                  << std::sqrt(variance) << ", stated " << std::sqrt(variances));
    CHECK(std::sqrt(variance / n) < 0.2 * exact * exact);
    CHECK(std::abs(mean - exact * exact) < 4.0 * std::sqrt(variance / n));
    // The mean of n squares, whose own spread over pixels is that of exponential values.
    CHECK(variances == Approx(variance).epsilon(0.25));
}

TEST_CASE("The noise of a film is the error that it has", "[relative][film][statistics]") {
    const Picture truth = scene_picture();
    for (const bool stratified : {false, true})
        for (const std::uint32_t passes : {8u, 64u}) {
            double errors = 0.0, noises = 0.0, of_passes = 0.0;
            const int seeds = 20;
            for (int seed = 0; seed < seeds; ++seed) {
                const Film film = noisy_film(truth, passes, std::uint64_t(seed), stratified && passes >= 16);
                const double e = error_of(film.beauty(), truth).error;
                errors += e * e / seeds, noises += film.noise() / seeds;
                const RelativeWeights weights = relative_weights(truth, width, height);
                of_passes +=
                    relative_error(film.beauty(), truth, weights, film.beauty_variance_of_mean()).noise /
                    seeds;
            }
            INFO(passes << " passes, stratified " << stratified << ": error " << std::sqrt(errors)
                        << ", noise " << noises << ", of independent passes " << of_passes);
            if (!stratified || passes < 16) {
                // A variance from 20 * 324 lit pixels with the kurtosis 9 of exponential values is good to
                // sqrt(8 / 6480) = 3.5 %, its root to 1.8 %; what remains is that of the weights, 10 % with 8
                // passes whose own spread is a third of the light.
                CHECK(noises == Approx(std::sqrt(errors)).epsilon(0.12));
            } else {
                // Independent passes would have several times the error: the blocks must be seen. Their means
                // are independent, unlike Sobol points', which a trend that ends has to show: two pairs of
                // blocks and one of pairs, of 320 pixels, are good to 6 %, their root to 3 %; and the weights
                // as above.
                CHECK(of_passes > 2.0 * std::sqrt(errors));
                CHECK(noises == Approx(std::sqrt(errors)).epsilon(0.12));
            }
        }
}

TEST_CASE("A lamp in the picture does not hide the noise", "[relative][film]") {
    const double without = noisy_film(scene_picture(1.0f, 1.0f), 8, 1, false).noise();
    const double with = noisy_film(scene_picture(1.0f, 100000.0f), 8, 1, false).noise();
    CHECK(with == Approx(without).epsilon(0.05));  // four of 324 pixels, and their neighbours
    CHECK(without == Approx(1.0 / std::sqrt(8.0)).epsilon(0.12));
}

TEST_CASE("A pixel's own noise is not in its weight", "[relative][statistics]") {
    // By the weights of a noisy picture, its own noise counts as much as that of another one.
    constexpr int size = 64, count = size * size;
    double own = 0.0, other = 0.0;
    constexpr int pictures = 20;
    for (std::uint64_t seed = 0; seed < pictures; ++seed) {
        Rng rng(hash_keys(seed, 77));
        Picture picture;
        for (int p = 0; p < count; ++p) picture.push_back(Rgb(float(1.0 + 0.5 * normal(rng))));
        const RelativeWeights weights = relative_weights(picture, Picture(count, Rgb(0.25f)), size, size);
        for (std::size_t p = 0; p < count; ++p) {
            own += weights.weight[p] * sqr(double(picture[p].x) - 1.0);
            other += weights.weight[p] * sqr(0.5 * normal(rng));
        }
    }
    // The square of a normal variable has the variance 2.
    CHECK(std::fabs(own / other - 1.0) < 3.0 * std::sqrt(2.0 * 2.0 / double(pictures * count)));
}
