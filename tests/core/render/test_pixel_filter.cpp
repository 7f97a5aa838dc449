// Pixel filters: moments of the offsets against the analytic filter.
#include <cmath>
#include <functional>

#include "core/math/random.h"
#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

struct Moments {
    double mean = 0.0, variance = 0.0, fourth = 0.0, within = 0.0;
};

// Of the density proportional to f over [-radius, radius], by the midpoint rule; `within`: the share of
// [-radius/4, radius/4].
Moments analytic(const std::function<double(double)>& f, double radius) {
    double total = 0.0;
    Moments m;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
        const double x = radius * (2.0 * (i + 0.5) / n - 1.0), w = f(x);
        total += w, m.variance += w * x * x, m.fourth += w * x * x * x * x;
        if (std::fabs(x) < radius / 4) m.within += w;
    }
    m.variance /= total, m.fourth /= total, m.within /= total;
    return m;
}

void check_filter(const std::string& name, float radius, float stddev,
                  const std::function<double(double)>& f) {
    const auto filter = make_pixel_filter(name, radius, stddev);
    const Moments expected = analytic(f, radius);
    const int n = 400000;
    Rng rng(hash_keys(3, std::uint64_t(radius * 1000)));
    double mean[2] = {0, 0}, square[2] = {0, 0}, product = 0.0, within = 0.0;
    for (int i = 0; i < n; ++i) {
        const Vec2 o = filter->sample_offset(rng.next_vec2());
        REQUIRE(std::fabs(o.x) <= radius);
        REQUIRE(std::fabs(o.y) <= radius);
        for (int a = 0; a < 2; ++a) mean[a] += o[a], square[a] += double(o[a]) * o[a];
        product += double(o.x) * o.y;
        within += std::fabs(o.x) < radius / 4 ? 1.0 : 0.0;
    }
    INFO(name);
    // Five standard deviations of each estimate.
    const double sigma_mean = std::sqrt(expected.variance / n);
    const double sigma_square = std::sqrt((expected.fourth - expected.variance * expected.variance) / n);
    for (int a = 0; a < 2; ++a) {
        CHECK(std::fabs(mean[a] / n) < 5.0 * sigma_mean);
        CHECK(std::fabs(square[a] / n - expected.variance) < 5.0 * sigma_square);
    }
    CHECK(std::fabs(product / n) < 5.0 * expected.variance / std::sqrt(double(n)));
    CHECK(std::fabs(within / n - expected.within) <
          5.0 * std::sqrt(expected.within * (1.0 - expected.within) / n));
}

}  // namespace

TEST_CASE("Offsets of pixel filters follow the filter", "[filter]") {
    check_filter("box", 0.5f, 0.0f, [](double) { return 1.0; });
    check_filter("box", 1.5f, 0.0f, [](double) { return 1.0; });
    check_filter("tent", 1.0f, 0.0f, [](double x) { return 1.0 - std::fabs(x); });
    const auto gaussian = [](double radius, double s) {
        return [=](double x) {
            return std::fmax(0.0, std::exp(-x * x / (2 * s * s)) - std::exp(-radius * radius / (2 * s * s)));
        };
    };
    check_filter("gaussian", 2.0f, 0.5f, gaussian(2.0, 0.5));
    check_filter("gaussian", 1.0f, 1.0f, gaussian(1.0, 1.0));  // here the subtracted value matters
    check_filter("gaussian", 8.0f, 0.25f, gaussian(8.0, 0.25));
}

TEST_CASE("The corners of the unit square are finite offsets within the radius", "[filter]") {
    for (const std::string name : {"box", "tent", "gaussian"}) {
        const auto filter = make_pixel_filter(name, 2.0f, 0.5f);
        for (const float u : {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon}) {
            const Vec2 o = filter->sample_offset({u, 1.0f - u > 0.5f ? one_minus_epsilon : 0.0f});
            CHECK(is_finite(o.x));
            CHECK(is_finite(o.y));
            CHECK(std::fabs(o.x) <= 2.0f);
            CHECK(std::fabs(o.y) <= 2.0f);
        }
        CHECK(filter->sample_offset(Vec2(0.5f)).x == Approx(0.0f).margin(1e-6));
    }
}

TEST_CASE("Unknown filters and impossible radii are refused", "[filter]") {
    CHECK_THROWS_AS(make_pixel_filter("gausian", 2.0f, 0.5f), InputError);

    CHECK_THROWS_AS(make_pixel_filter("box", 0.0f, 0.5f), InputError);
    CHECK_THROWS_AS(make_pixel_filter("tent", std::nanf(""), 0.5f), InputError);
    CHECK_THROWS_AS(make_pixel_filter("gaussian", 2.0f, 0.0f), InputError);
}
