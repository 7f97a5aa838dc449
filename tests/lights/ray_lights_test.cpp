// Distances on lines, lines through media, and what ray lights send to receivers, against quadrature and
// closed forms.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/math/random.h"
#include "core/scene/scene.h"
#include "lights/ray_lights/line_candidates.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::lights;

namespace {

constexpr std::array<float, 4> even{1.0f, 1.0f, 1.0f, 1.0f}, uneven{0.5f, 3.0f, 0.0f, 1.0f};

/// The integral of the density over [begin, end], as it is sampled from: by the mean of f = 1 over samples at
/// midpoints. Each f/pdf times pdf is 1, so what is integrated is 1/pdf: the length of the part where the
/// weights are not zero.
template <typename Density>
double length_by_samples(const Density& density, double begin, double end, double length,
                         std::span<const float> weights, int n = 200000) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        const auto s = sample_line(density, begin, end, length, weights, float((i + 0.5) / n));
        if (s) sum += 1.0 / s->pdf_distance / n;
    }
    return sum;
}

/// The integral of the pdf, by midpoints, cell by cell: weight * density / sum is what a sample there would
/// have.
template <typename Density>
double pdf_integral(const Density& density, double begin, double end, double length,
                    std::span<const float> weights) {
    const auto any = sample_line(density, begin, end, length, weights, 0.5f);
    REQUIRE(any);
    // The factor between weight * density and the pdf is the same everywhere.
    const auto cell = [&](double t) {
        return weights[std::min(std::size_t(t / length * double(weights.size())), weights.size() - 1)];
    };
    const double factor = any->pdf_distance / (double(cell(any->position)) * density.density(any->position));
    double sum = 0.0;
    const int n = 400000;
    for (int i = 0; i < n; ++i) {
        const double t = begin + (end - begin) * (i + 0.5) / n;
        sum += factor * double(cell(t)) * density.density(t) * (end - begin) / n;
    }
    return sum;
}

MediumLine clear_line(const Vec3& origin, const Vec3& direction, float length) {
    MediumLine line;
    line.origin = origin, line.direction = glm::normalize(direction), line.length = length;
    line.homogeneous = true, line.sigma_s = Rgb(1.0f);  // scatters, takes nothing: only 1/w^2 is left
    line.weights[0] = 1.0f;
    return line;
}

constexpr double phases =
    1.0 / (16.0 * std::numbers::pi * std::numbers::pi);  ///< of two isotropic scatterings

/// Mean of connections between two lines over n x n midpoints of the square, over the phase functions.
double line_integral(const MediumLine& eye, const MediumLine& light, int n) {
    EyeLine x;
    x.line = eye, x.throughput = Rgb(1.0f), x.max_depth = 10;
    RayLight y;
    y.line = light, y.power = Rgb(1.0f);
    Rng rng(1);
    TrackingCounters counters;
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (const auto c = connect(x, y, {float((i + 0.5) / n), float((j + 0.5) / n)}, {rng, counters}))
                sum += double(c->value.x);
    return sum / (double(n) * n) / phases;
}

}  // namespace

TEST_CASE("densities on lines integrate to 1", "[ray_lights][pdf]") {
    for (const double sine : {1.0, 0.3, 1e-3, 1e-9, 0.0})
        for (const double h : {1.0, 0.05, 1e-3})
            for (const auto weights :
                 {std::span<const float>(even).first(1), std::span<const float>(uneven)}) {
                const InverseDistance density{0.7, h, sine};
                INFO("sine " << sine << " h " << h << " cells " << weights.size());
                CHECK(pdf_integral(density, 0.0, 3.0, 3.0, weights) == Approx(1.0).epsilon(1e-4));
                const double zero =
                    weights.size() > 1 ? 0.75 : 0.0;  // where the weight is zero nothing is sampled
                CHECK(length_by_samples(density, 0.0, 3.0, 3.0, weights) == Approx(3.0 - zero).epsilon(1e-3));
            }
    for (const double h : {1.0, 0.05, 1e-2})
        for (const double nearest : {-1.0, 0.7, 5.0}) {
            const InverseSquare density{nearest, h};
            CHECK(pdf_integral(density, 0.5, 2.5, 3.0, even) == Approx(1.0).epsilon(1e-4));
            CHECK(length_by_samples(density, 0.5, 2.5, 3.0, even) == Approx(2.0).epsilon(2e-3));
        }
}

// Novak et al. 2012: over an infinite eye ray 1/w^2 is pi / sqrt(h^2 + u^2), over a light from -a to a that
// is 2 pi asinh(a/h).
TEST_CASE("a perpendicular ray light seen by an infinite eye ray is 2 pi asinh(a/h)", "[ray_lights]") {
    const float far = 1e6f;
    for (const double a : {0.5, 3.0})
        for (const double h : {2.0, 0.1, 1e-3}) {
            const MediumLine eye = clear_line({0, 0, -far}, {0, 0, 1}, 2.0f * far);
            const MediumLine light = clear_line({float(-a), float(h), 0}, {1, 0, 0}, float(2.0 * a));
            const double exact = 2.0 * std::numbers::pi * std::asinh(a / h);
            INFO("a " << a << " h " << h);
            // Density proportional to the integrand: every sample is the integral, but for the eye ray's
            // ends, a/far of it, and single precision.
            CHECK(line_integral(eye, light, 1) == Approx(exact).epsilon(3e-5));
            CHECK(line_integral(eye, light, 20) == Approx(exact).epsilon(3e-5));
            CHECK_FALSE(line_integral(eye, light, 20) ==
                        Approx(std::numbers::pi * std::asinh(2.0 * a / h)).epsilon(1e-2));
        }
}

TEST_CASE("lines of any position are what quadrature says", "[ray_lights]") {
    Rng rng(7);
    const auto point = [&] {
        return Vec3(rng.next_float(), rng.next_float(), rng.next_float()) * 2.0f - 1.0f;
    };
    for (int k = 0; k < 6; ++k) {
        const MediumLine eye = clear_line(point(), point(), 1.0f + rng.next_float()),
                         light = clear_line(point() + Vec3(0, 0, 1.5f), point(), 1.0f + rng.next_float());
        double exact = 0.0;
        const int n = 1000;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const Vec3d w = light.at(light.length * (i + 0.5) / n) - eye.at(eye.length * (j + 0.5) / n);
                exact += double(eye.length) * double(light.length) / glm::dot(w, w) / (double(n) * n);
            }
        CHECK(line_integral(eye, light, 60) == Approx(exact).epsilon(5e-3));
    }
}

TEST_CASE("parallel, crossing, empty and coincident lines are finite", "[ray_lights][extremes]") {
    const MediumLine eye = clear_line({0, 0, 0}, {0, 0, 1}, 4.0f);
    const double apart = line_integral(eye, clear_line({0, 1, 0}, {0, 0, 1}, 4.0f), 40);
    // Parallel lines: 2 (L atan(L/h)/h - log(1 + L^2/h^2)/2).
    CHECK(apart == Approx(2.0 * (4.0 * std::atan(4.0) - 0.5 * std::log(17.0))).epsilon(1e-3));
    CHECK(line_integral(eye, clear_line({0, 1, 4}, {0, 0, -1}, 4.0f), 40) == Approx(apart).epsilon(1e-3));
    // Nearly parallel goes over into parallel.
    for (const float slant : {1e-3f, 1e-5f, 1e-7f, 1e-9f})
        CHECK(line_integral(eye, clear_line({0, 1, 0}, {slant, 0, 1}, 4.0f), 40) ==
              Approx(apart).epsilon(2e-3));
    for (const MediumLine& light :
         {clear_line({-1, 0, 2}, {1, 0, 0}, 2.0f), clear_line({0, 0, 0}, {1, 0, 0}, 1.0f),
          clear_line({0, 0, 1}, {0, 0, 1}, 2.0f), clear_line({0, 0, 9}, {0, 0, -1}, 20.0f),
          clear_line({0, 1e-20f, 1}, {1e-20f, 0, 1}, 1.0f), clear_line({1e8f, 0, 1}, {0, 0, 1}, 1e8f)}) {
        const double value = line_integral(eye, light, 30);
        INFO(value);
        CHECK((std::isfinite(value) && value >= 0.0));
    }
    // The eye on the ray light, and lines of no length.
    CHECK(std::isfinite(
        line_integral(clear_line({0, 0, 0}, {0, 0, 1}, 1.0f), clear_line({-1, 0, 0}, {1, 0, 0}, 2.0f), 30)));
    CHECK(line_integral(eye, clear_line({0, 1, 0}, {0, 0, 1}, 0.0f), 4) == 0.0);
    CHECK(line_integral(clear_line({0, 1, 0}, {0, 0, 1}, 0.0f), eye, 4) == 0.0);
}

TEST_CASE("a subset of the ray lights counts for all", "[ray_lights]") {
    const std::array<double, 5> power{1.0, 1.0, 6.0, 6.25, 26.25};  // sums: the second has none
    const PowerSampling all(power, 0), three(power, 3);
    CHECK(all.count() == 5);
    CHECK(all.choose(2, 0.3f).index == 2);
    CHECK(all.choose(2, 0.3f).weight == 1.0f);
    REQUIRE(three.count() == 3);
    std::array<double, 5> counted{};
    const int n = 100000;
    for (int i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto choice = three.choose(k, float((i + 0.5) / n));
            counted[choice.index] += double(choice.weight) / n;
        }
    for (const std::size_t i : {0, 2, 3, 4}) CHECK(counted[i] == Approx(1.0).epsilon(1e-3));
    CHECK(counted[1] == 0.0);
    CHECK(PowerSampling({}, 3).count() == 0);
    CHECK(PowerSampling({}, 0).count() == 0);
}

TEST_CASE("connections by steps count every light once", "[ray_lights]") {
    // Importances of a lane, twice as large in the next; the third sends nothing, the fifth counts 3 times.
    const std::array<float, 5> expected{0.5f, 4.0f, 0.0f, 0.01f, 1.0f}, weight{1.0f, 1.0f, 1.0f, 1.0f, 3.0f};
    LineCandidates candidates;
    for (std::uint32_t k = 0; k < 5; ++k) {
        core::Lanes lanes;
        lanes[2] = expected[k], lanes[3] = 2.0f * expected[k];
        candidates.add(k, k % 2 == 0, weight[k], lanes);
    }
    CHECK(candidates.total()[0] == 0.0f);
    CHECK(candidates.total()[2] == Approx(7.51f));
    LineChoices choices;
    const auto pick = [&](int lane, float step, float start) -> const std::vector<LineChoice>& {
        core::Lanes steps, starts;
        for (int i = 0; i < ReceiverLanes::width; ++i) starts[i] = i == lane ? start : 1.0f;
        steps[lane] = step;
        candidates.choose(steps, starts, choices);
        return choices[std::size_t(lane)];
    };
    const auto counts = [&](float step) {
        std::array<double, 5> counted{};
        const int n = 100000;
        for (int i = 0; i < n; ++i) {
            for (const LineChoice& p : pick(2, step, float((i + 0.5) / n)))
                counted[p.light] += double(p.weight) / n;
        }
        return counted;
    };
    for (const float step : {0.0f, 0.3f, 1.0f, 5.0f}) {
        const auto counted = counts(step);
        INFO("step " << step);
        for (const std::size_t k : {0, 1, 3, 4}) CHECK(counted[k] == Approx(double(weight[k])).epsilon(2e-3));
        CHECK(counted[2] == 0.0);
    }
    const auto& some = pick(2, 1.0f, 0.5f);  // a VPL that is met four times is one connection
    CHECK(std::count_if(some.begin(), some.end(), [](const LineChoice& p) { return p.light == 1; }) == 1);
    CHECK(choices[3].empty());
    CHECK(pick(0, 1.0f, 0.5f).empty());
    candidates.clear();
    CHECK(pick(2, 1.0f, 0.5f).empty());
}

// Importance of connections: above 0 wherever light arrives, or it would be lost, and about the mean of the
// light that arrives.
TEST_CASE("expected light is about what arrives, and nowhere 0 where any does", "[ray_lights]") {
    Rng rng(11);
    TrackingCounters counters;
    const auto point = [&] {
        return Vec3(rng.next_float(), rng.next_float(), rng.next_float()) * 2.0f - 1.0f;
    };
    struct Seen {
        int arrive = 0, lost = 0, far_off = 0;
        void add(double mean, float expected) {
            if (!(mean > 0.0)) return;
            ++arrive, lost += expected > 0.0f ? 0 : 1;
            far_off += mean > 4.0 * double(expected) || double(expected) > 8.0 * mean ? 1 : 0;
        }
    };
    std::array<Seen, 3> seen;
    constexpr int n = 12;
    for (int k = 0; k < 300; ++k) {
        RayLight light;
        light.line = clear_line(point(), point(), 0.1f + 2.0f * rng.next_float());
        light.power = Rgb(1.0f);
        EyeLine eye;
        eye.line = clear_line(point(), point(), 0.5f + 2.0f * rng.next_float());
        eye.throughput = Rgb(0.7f), eye.max_depth = 10;
        VplSet vpls;
        VirtualPointLight& vpl = vpls.lights.emplace_back();
        vpl.position = point(), vpl.normal = vpl.shading_normal = glm::normalize(point());
        vpl.intensity = Rgb(2.0f);
        ReceiverLanes lanes;
        const Vec3 x = point(), normal = glm::normalize(point());
        lanes.x[5] = x.x, lanes.y[5] = x.y, lanes.z[5] = x.z;
        lanes.shading_x[5] = lanes.geometric_x[5] = normal.x,
        lanes.shading_y[5] = lanes.geometric_y[5] = normal.y;
        lanes.shading_z[5] = lanes.geometric_z[5] = normal.z;
        lanes.weight_r[5] = lanes.weight_g[5] = lanes.weight_b[5] = 0.3f, lanes.max_vpl_depth[5] = 10;
        EyeLines eyes;
        eyes.of[5] = &eye;
        const EyeReceivers along(eyes);
        const PointReceivers points(lanes, {}, 50.0f);
        core::Lanes expected[3];
        importance(light, along, expected[0]);
        importance(vpl, along, expected[1]);
        importance(light, points, expected[2]);
        std::array<double, 3> mean{};
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const Vec2 u{(float(i) + 0.5f) / n, (float(j) + 0.5f) / n};
                const LineContext context{rng, counters};
                if (const auto c = connect(eye, light, u, context)) mean[0] += double(c->value.x) / (n * n);
                if (const auto c = connect(eye, vpls, vpl, u.x, context))
                    mean[1] += double(c->value.x) / (n * n);
                if (const auto c = connect(lanes, 5, light, u.x, 50.0f, context))
                    mean[2] += double(c->value.x) / (n * n);
            }
        for (std::size_t kind = 0; kind < 3; ++kind) seen[kind].add(mean[kind], expected[kind][5]);
        CHECK(expected[0][4] == 0.0f);  // an idle lane
    }
    for (std::size_t kind = 0; kind < 3; ++kind) {
        INFO("kind " << kind << ": far off " << seen[kind].far_off << " of " << seen[kind].arrive);
        CHECK(seen[kind].arrive > 100);
        CHECK(seen[kind].lost == 0);
        CHECK(seen[kind].far_off < seen[kind].arrive / 5);
    }
}
