// Metrics against numbers worked out by hand, on pictures of a few pixels.
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/math/random.h"
#include "core/metrics/metrics.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

using Picture = std::vector<Rgb>;

const float nan_value = std::numeric_limits<float>::quiet_NaN();

Picture constant(int width, int height, float value) {
    return Picture(std::size_t(width) * std::size_t(height), Rgb(value));
}

Picture noise(int width, int height, std::uint64_t seed) {
    Picture picture;
    Rng rng(seed);
    for (int i = 0; i < width * height; ++i)
        picture.push_back({rng.next_float(), rng.next_float(), rng.next_float()});
    return picture;
}

bool all_nan(const ImageMetrics& m) {
    for (const MetricDefinition& d : metric_definitions())
        if (!std::isnan(m.*d.value)) return false;
    return true;
}

}  // namespace

TEST_CASE("Every metric of two by two pixels is what the definition says", "[metrics]") {
    // One channel differs in three of the four pixels; d: red +1 over 1, green -0.5 over 2, blue +0.3 over 0.
    const Picture reference = {{1, 0, 0}, {0, 2, 0}, {0, 0, 0}, {1, 1, 1}};
    const Picture image = {{2, 0, 0}, {0, 1.5f, 0}, {0, 0, 0.3f}, {1, 1, 1}};
    const ImageMetrics m = compare_images(image, reference, 2, 2);
    CHECK(m.pixels == 4);
    CHECK(m.non_finite_either == 0);
    // Red 1 + 1 = 2 of four pixels; green 2 + 1 = 3; blue 1.
    CHECK(m.mean_reference == std::array<double, 3>{0.5, 0.75, 0.25});
    CHECK(m.mean_image[0] == 0.75);
    CHECK(m.mean_image[1] == 0.625);
    CHECK(m.mean_image[2] == Approx(0.325));
    CHECK(m.average_reference == 0.5);
    CHECK(m.average_image == Approx(6.8 / 12));
    // Squares 1, 0.25, 0.09; absolute values 1, 0.5, 0.3; twelve values in all.
    CHECK(m.mse == Approx(1.34 / 12));
    CHECK(m.rmse == Approx(std::sqrt(1.34 / 12)));
    CHECK(m.mae == Approx(1.8 / 12));
    CHECK(m.mape == Approx((1 / 1.01 + 0.5 / 2.01 + 0.3 / 0.01) / 12));
    CHECK(m.smape == Approx((2 / 3.01 + 1 / 3.51 + 0.6 / 0.31) / 12));
    CHECK(m.rel_mse == Approx((1 / 1.01 + 0.25 / 4.01 + 0.09 / 0.01) / 12));
    CHECK(m.rel_mse_trimmed == m.rel_mse);  // a thousandth of four pixels is none
    CHECK(m.mrse == Approx((1 / (1.01 * 1.01) + 0.25 / (2.01 * 2.01) + 0.09 / 0.0001) / 12));
    // d per pixel 1/3, -1/6, 1/10, 0: mean 1/15; squared distances to it sum to
    // 16/225 + 49/900 + 1/900 + 1/225 = 118/900.
    CHECK(m.mean_difference == Approx((1.0 / 15) / 0.5));
    CHECK(m.mean_difference_standard_error == Approx(std::sqrt(118.0 / 900 / 3 / 4) / 0.5));
    CHECK(std::isnan(m.ssim));  // no room for a window
}

TEST_CASE("A picture has no error against itself", "[metrics]") {
    const Picture picture = noise(20, 15, 3);
    const ImageMetrics m = compare_images(picture, picture, 20, 15);
    for (const MetricDefinition& d : metric_definitions()) {
        INFO(d.name);
        const std::string name = d.name;
        if (name == "noise" || name == "bias_standard_error" || name == "error_standard_error")
            CHECK(std::isnan(m.*d.value));  // the pictures do not say their variance
        else
            CHECK(m.*d.value == Approx(std::string(d.name) == "ssim" ? 1.0 : 0.0).margin(1e-12));
    }
}

TEST_CASE("A planted two percent shows up as such", "[metrics]") {
    const Picture reference = constant(12, 12, 3.0f);
    Picture image = reference;
    for (Rgb& p : image) p *= 1.02f;
    const ImageMetrics m = compare_images(image, reference, 12, 12);
    CHECK(m.bias == Approx(0.02).epsilon(1e-4));
    CHECK(m.error == Approx(0.02).epsilon(1e-4));
    CHECK(m.mean_difference == Approx(0.02).epsilon(1e-4));
    CHECK(m.mean_difference_standard_error < 1e-6);
    CHECK(std::isnan(m.bias_standard_error));  // the noise of the image is unknown
    CHECK(m.rmse == Approx(0.06).epsilon(1e-4));
    CHECK(compare_images(reference, image, 12, 12).bias == Approx(-0.02 / 1.02).epsilon(1e-4));
}

TEST_CASE("The standard error of the mean difference is the spread over repetitions of independent pixels",
          "[metrics]") {
    const Picture reference = constant(30, 30, 0.5f);
    double sum = 0.0, squares = 0.0, estimated = 0.0;
    const int n = 400;
    for (int i = 0; i < n; ++i) {
        const ImageMetrics m = compare_images(noise(30, 30, std::uint64_t(i)), reference, 30, 30);
        sum += m.mean_difference, squares += m.mean_difference * m.mean_difference;
        estimated += m.mean_difference_standard_error / n;
    }
    const double spread = std::sqrt((squares - sum * sum / n) / (n - 1));
    // A standard deviation from 400 values is good to 1 / sqrt(800) = 3.5 %: four of these.
    CHECK(estimated == Approx(spread).epsilon(0.14));
    CHECK(std::fabs(sum / n) < 4.0 * spread / std::sqrt(double(n)));
}

TEST_CASE("Trimming leaves out exactly the largest thousandth", "[metrics]") {
    const Picture reference = constant(50, 40, 1.0f);  // 2000 pixels: two are left out
    Picture image = reference;
    image[7] = Rgb(101.0f), image[1234] = Rgb(1001.0f), image[1999] = Rgb(3.0f);
    const ImageMetrics m = compare_images(image, reference, 50, 40);
    CHECK(m.rel_mse_trimmed == Approx(4.0 / 1.01 / 1998));
    CHECK(m.rel_mse == Approx((1e4 + 1e6 + 4.0) / 1.01 / 2000));
    const ImageMetrics fewer = compare_images(Picture(image.begin(), image.begin() + 1999),
                                              Picture(reference.begin(), reference.begin() + 1999), 1999, 1);
    CHECK(fewer.rel_mse_trimmed == Approx(1e4 / 1.01 / 1998));  // one of 1999
}

TEST_CASE("SSIM of constant pictures follows from the formula", "[metrics][ssim]") {
    // No variance: (2 a r + C1) / (a^2 + r^2 + C1), C1 = 1e-4. Twice as bright: a = 2/3, r = 1/2.
    const double exact = (2.0 / 3 + 1e-4) / (4.0 / 9 + 1.0 / 4 + 1e-4);
    CHECK(compare_images(constant(16, 13, 8.0f), constant(16, 13, 4.0f), 16, 13).ssim == Approx(exact));
    // Exposure changes nothing when both pictures have it.
    CHECK(compare_images(constant(16, 13, 8e6f), constant(16, 13, 4e6f), 16, 13).ssim == Approx(exact));
    CHECK(std::isnan(compare_images(constant(16, 13, 1.0f), constant(16, 13, 0.0f), 16, 13).ssim));
}

TEST_CASE("SSIM of a single window is the formula with weighted moments", "[metrics][ssim]") {
    // 11 x 11 pixels hold one window; the weights are those of the product of two Gaussians.
    std::vector<double> a, r;
    Rng rng(5);
    double total = 0.0, ma = 0.0, mr = 0.0, aa = 0.0, rr = 0.0, ar = 0.0;
    for (int y = -5; y <= 5; ++y)
        for (int x = -5; x <= 5; ++x) {
            const double w = std::exp(-(x * x + y * y) / (2.0 * 1.5 * 1.5));
            a.push_back(rng.next_float()), r.push_back(0.5 * a.back() + 0.5 * rng.next_float());
            total += w, ma += w * a.back(), mr += w * r.back();
            aa += w * a.back() * a.back(), rr += w * r.back() * r.back(), ar += w * a.back() * r.back();
        }
    ma /= total, mr /= total;
    const double va = aa / total - ma * ma, vr = rr / total - mr * mr, covariance = ar / total - ma * mr;
    const double exact =
        (2 * ma * mr + 1e-4) * (2 * covariance + 9e-4) / ((ma * ma + mr * mr + 1e-4) * (va + vr + 9e-4));
    CHECK(mean_ssim(a, r, 11, 11) == Approx(exact).epsilon(1e-10));
    CHECK(mean_ssim(a, r, 11, 11) == mean_ssim(r, a, 11, 11));
    CHECK(exact < 0.95);
}

TEST_CASE("What depends on a NaN is NaN, and what does not is not", "[metrics]") {
    const Picture good = constant(16, 16, 1.0f);
    for (const float bad : {nan_value, infinity, -infinity}) {
        Picture image = good, reference = good;
        image[3].g = bad;
        image[9] = Rgb(bad);
        reference[9].b = bad;
        const ImageMetrics m = compare_images(image, good, 16, 16);
        CHECK(m.non_finite_image == 2);
        CHECK(m.non_finite_reference == 0);
        CHECK(m.non_finite_either == 2);
        CHECK(m.non_finite_fraction() == 2.0 / 256);
        CHECK(all_nan(m));
        CHECK(std::isnan(m.average_image));
        CHECK(m.average_reference == 1.0);

        const ImageMetrics both = compare_images(image, reference, 16, 16);
        CHECK(both.non_finite_either == 2);
        CHECK(both.non_finite_reference == 1);
        CHECK(both.mean_reference[0] == 1.0);
        CHECK(std::isnan(both.mean_reference[2]));
    }
}

TEST_CASE("The largest floats overflow nothing", "[metrics]") {
    const float largest = std::numeric_limits<float>::max();
    const ImageMetrics m = compare_images(constant(12, 12, largest), constant(12, 12, -largest), 12, 12);
    CHECK(m.non_finite_either == 0);
    CHECK(std::isfinite(m.mse));
    CHECK(m.bias == Approx(-2.0));
    CHECK(compare_images(constant(12, 12, largest), constant(12, 12, largest), 12, 12).ssim == Approx(1.0));
}

TEST_CASE("Pictures of different sizes are no comparison", "[metrics]") {
    const Picture four = constant(2, 2, 1.0f), six = constant(2, 3, 1.0f);
    CHECK_THROWS_AS(compare_images(four, six, 2, 2), std::invalid_argument);
    CHECK_THROWS_AS(compare_images(four, four, 2, 3), std::invalid_argument);
    CHECK_THROWS_AS(compare_images({}, {}, 0, 0), std::invalid_argument);
}
