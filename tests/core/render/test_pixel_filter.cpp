// Pixel filters: moments of the offsets against the analytic filter.
#include <cmath>
#include <functional>
#include <set>

#include "core/math/random.h"
#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "core/render/splat.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"
#include "tests/support/registered_cases.h"
#include "tests/support/render_statistics.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

struct Moments {
    double mean = 0.0, variance = 0.0, fourth = 0.0, within = 0.0;
};

// Moments of the density proportional to f over [-radius, radius], by the midpoint rule; `within`:
// probability of [-radius/4, radius/4].
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

namespace {

/// The square of a filter's reach as the sphere, with equal areas: x becomes the cosine, y the azimuth.
Vec3 on_sphere(const Vec2& offset, float radius) {
    const double z = double(offset.x) / double(radius), r = std::sqrt(std::fmax(0.0, 1.0 - z * z));
    const double phi = double(pi) * (double(offset.y) / double(radius) + 1.0);
    return Vec3(Vec3d(r * std::cos(phi), r * std::sin(phi), z));
}
Vec2 from_sphere(const Vec3& w, float radius) {
    double phi = std::atan2(double(w.y), double(w.x));
    if (phi < 0.0) phi += 2.0 * double(pi);
    return {w.z * radius, float((phi / double(pi) - 1.0) * double(radius))};
}

struct FilterCase {
    std::string type;
    float radius, stddev;
    std::unique_ptr<PixelFilter> filter() const { return make_pixel_filter(type, radius, stddev); }
};
const std::vector<FilterCase> filter_cases = {
    {"box", 0.5f, 0.5f},      {"box", 1.5f, 0.5f},      {"tent", 1.0f, 0.5f},     {"tent", 2.5f, 0.5f},
    {"gaussian", 2.0f, 0.5f}, {"gaussian", 1.0f, 1.0f}, {"gaussian", 8.0f, 2.0f}, {"gaussian", 8.0f, 0.25f}};

DirectionSampler offsets(const PixelFilter& filter) {
    return [&filter](Rng& rng) -> std::optional<Vec3> {
        return on_sphere(filter.sample_offset(rng.next_vec2()), filter.radius());
    };
}
DirectionDensity offset_density(const PixelFilter& filter, double factor = 1.0) {
    return [&filter, factor](const Vec3& w) {
        const float r = filter.radius();
        return factor * double(filter.pdf_area(from_sphere(w, r))) * double(r) * double(r) / double(pi);
    };
}

Chi2Options filter_options(const FilterCase& c) {
    Chi2Options o;
    o.name = "filter_" + c.type;
    o.seed = hash_keys(0x66696c74ull, std::uint64_t(1000 * c.radius), std::uint64_t(1000 * c.stddev));
    o.cos_cells = 32, o.phi_cells = 32, o.subdivisions = 3, o.tests = int(filter_cases.size());
    return o;
}

}  // namespace

TEST_CASE("Offsets of pixel filters follow their density", "[filter][chi2]") {
    for (const FilterCase& c : filter_cases) {
        const auto filter = c.filter();
        Chi2Options o = filter_options(c);
        const Chi2Result result = chi2_test(offsets(*filter), offset_density(*filter), o);
        INFO(result.message);
        CHECK(result.passed);
        CHECK(result.integral == Approx(1.0).epsilon(1e-3));
        CHECK(filter->radius() <= c.radius);
        for (const Vec2& far : {Vec2(1.001f, 0.0f), Vec2(0.0f, -1.001f)})
            CHECK(filter->pdf_area(far * filter->radius()) == 0.0f);
        // Planted: a factor, and a filter a little narrower.
        o.write_table = false;
        CHECK_FALSE(chi2_test(offsets(*filter), offset_density(*filter, 0.97), o).passed);
        // (the cells are too coarse for the one that is cut far out).
        const auto narrow = make_pixel_filter(c.type, c.radius, 0.97f * c.stddev);
        if (c.type == "gaussian" && c.stddev < c.radius && filter->radius() <= 4.0f * c.stddev)
            CHECK_FALSE(chi2_test(offsets(*filter), offset_density(*narrow), o).passed);
    }
}

TEST_CASE("every registered filter has a chi-square case", "[filter][chi2][coverage]") {
    std::set<std::string> tested;
    for (const FilterCase& c : filter_cases) tested.insert(c.type);
    for (const std::string& complaint : untested_types(registry(), Category::rfilter, tested))
        FAIL_CHECK(complaint);
}

TEST_CASE("Splats reach the pixels whose filter holds the position", "[filter][splat]") {
    constexpr int width = 7, height = 5;
    for (const FilterCase& c : filter_cases) {
        const auto filter = c.filter();
        const float r = filter->radius();
        Rng rng(5);
        for (int i = 0; i < 2000; ++i) {
            const Vec2 at = Vec2(-r) + (Vec2(width, height) + 2.0f * r) * rng.next_vec2();
            double found[width][height] = {};
            for_each_splat(*filter, at, width, height, [&](int x, int y, float f) {
                REQUIRE((x >= 0 && x < width && y >= 0 && y < height && f > 0.0f));
                REQUIRE(found[x][y] == 0.0);
                found[x][y] = f;
            });
            for (int x = 0; x < width; ++x)
                for (int y = 0; y < height; ++y)
                    REQUIRE(found[x][y] ==
                            double(filter->pdf_area(at - Vec2(float(x) + 0.5f, float(y) + 0.5f))));
        }
    }
    // Box and tent share every point of the film out without a rest.
    for (const auto& filter : {make_pixel_filter("box", 0.5f, 0.5f), make_pixel_filter("tent", 1.0f, 0.5f)})
        for (const Vec2& at : {Vec2(3.0f, 2.0f), Vec2(2.25f, 3.5f), Vec2(4.9999f, 1.0001f)}) {
            double sum = 0.0;
            for_each_splat(*filter, at, width, height, [&](int, int, float f) { sum += double(f); });
            CHECK(sum == Approx(1.0).epsilon(1e-5));
        }
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
