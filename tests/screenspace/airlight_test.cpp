// The air-light integral against adaptive quadrature in another variable, and for isotropic scattering
// against its closed form, at the extremes.
#include "screenspace/in_scattering/airlight.h"

#include <complex>
#include <numbers>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::screenspace;

namespace {

constexpr double accuracy = 1e-8;
using Real = long double;
constexpr Real pi_l = std::numbers::pi_v<Real>;

struct Case {
    PassingRay ray;
    double t0, t1, sigma_t, g;
};

/// A light `distance` from a ray, whose point nearest to it is at `nearest`.
PassingRay passing(double nearest, double distance) {
    PassingRay p(Ray{}, Vec3(0.0f));
    p.nearest = nearest, p.distance = distance;
    return p;
}

/// The integrand along the ray.
Real integrand(const Case& c, Real t) {
    const Real along = t - Real(c.ray.nearest), h = c.ray.distance, d = std::sqrt(along * along + h * h);
    const Real g = c.g, q = 1.0L + g * g + 2.0L * g * along / d;
    return std::exp(-Real(c.sigma_t) * (t - Real(c.t0) + d)) * (1.0L - g * g) /
           (4.0L * pi_l * q * std::sqrt(q) * d * d);
}

Real simpson(const Case& c, Real a, Real b, Real fa, Real fm, Real fb, Real tolerance, int depth) {
    const Real m = 0.5L * (a + b), f1 = integrand(c, 0.5L * (a + m)), f2 = integrand(c, 0.5L * (m + b));
    const Real whole = (b - a) / 6.0L * (fa + 4.0L * fm + fb);
    const Real halves = (b - a) / 12.0L * (fa + 4.0L * f1 + 2.0L * fm + 4.0L * f2 + fb);
    if (depth == 0 || std::abs(halves - whole) <= 15.0L * tolerance) return halves + (halves - whole) / 15.0L;
    return simpson(c, a, m, fa, f1, fm, 0.5L * tolerance, depth - 1) +
           simpson(c, m, b, fm, f2, fb, 0.5L * tolerance, depth - 1);
}

/// Adaptive Simpson, to 1e-10 of the sum, on pieces that double in length from both ends and from the point
/// nearest to the light. Beyond 1e12 times all lengths is infinity.
double quadrature(const Case& c) {
    const Real h = c.ray.distance, nearest = c.ray.nearest, t0 = c.t0;
    const Real end = std::isfinite(c.t1) ? Real(c.t1) : 1e12L * (h + std::abs(nearest) + std::abs(t0));
    std::vector<Real> cuts = {t0, end};
    for (int k = -10; k < 130; ++k) {
        const Real share = std::pow(2.0L, -Real(k)), reach = h / (16.0L * share);
        for (const Real cut :
             {t0 + share * (end - t0), end - share * (end - t0), nearest - reach, nearest + reach})
            if (cut > t0 && cut < end) cuts.push_back(cut);
    }
    std::sort(cuts.begin(), cuts.end());
    const auto sum = [&](Real tolerance) {
        Real total = 0.0L;
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
            const Real a = cuts[i], b = cuts[i + 1];
            total += simpson(c, a, b, integrand(c, a), integrand(c, 0.5L * (a + b)), integrand(c, b),
                             tolerance, tolerance > 0.0L ? 20 : 3);
        }
        return total;
    };
    return double(sum(1e-10L * sum(0.0L)));
}

double relative_error(const Case& c) {
    const double expected = quadrature(c);
    if (expected < 1e-290) return 0.0;
    return std::abs(airlight(c.ray, c.t0, c.t1, c.sigma_t, c.g) / expected - 1.0);
}

/// E_1 for the right half plane, by its continued fraction or its series.
std::complex<double> exponential_integral(std::complex<double> z) {
    if (std::abs(z) > 2.0) {
        std::complex<double> b = z + 1.0, c = 1e300, d = 1.0 / b, f = d;  // modified Lentz
        for (int i = 1; i < 500; ++i) {
            b += 2.0;
            d = 1.0 / (b - double(i) * double(i) * d), c = b - double(i) * double(i) / c;
            f *= c * d;
        }
        return std::exp(-z) * f;
    }
    std::complex<double> sum = -0.57721566490153286061 - std::log(z), term = 1.0;
    for (int k = 1; k < 60; ++k) term *= -z / double(k), sum -= term / double(k);
    return sum;
}

/// With x = (d + s) / h and tau = sigma_t h the isotropic integral is that of 2 exp(-tau x) / (1 + x^2), and
/// 1 / (1 + x^2) the imaginary part of 1 / (x - i) (Pegoraro & Parker 2009).
double closed_form(const Case& c) {
    const double h = c.ray.distance, tau = c.sigma_t * h, s0 = c.t0 - c.ray.nearest,
                 s1 = c.t1 - c.ray.nearest;
    const auto up_from = [&](double s) {
        const std::complex<double> i(0.0, 1.0), x((std::hypot(s, h) + s) / h, 0.0);
        return std::imag(std::exp(-i * tau) * exponential_integral(tau * (x - i)));
    };
    return std::exp(c.sigma_t * s0) * 2.0 * (up_from(s0) - up_from(s1)) / (4.0 * std::numbers::pi * h);
}

}  // namespace

TEST_CASE("Air light is the closed form where scattering is isotropic", "[airlight]") {
    double worst = 0.0;
    for (const double sigma_t : {0.01, 0.3, 2.0, 9.0})
        for (const double h : {0.02, 0.5, 3.0})
            for (const double nearest : {-1.0, 0.0, 2.0, 5.0}) {
                const Case c = {passing(nearest, h), 0.0, 4.0, sigma_t, 0.0};
                const double error = airlight(c.ray, c.t0, c.t1, c.sigma_t, 0.0) / closed_form(c) - 1.0;
                worst = std::max(worst, std::abs(error));
            }
    CHECK(worst < accuracy);
}

TEST_CASE("Air light is adaptive quadrature, at all sizes", "[airlight]") {
    Rng rng(3);
    const auto power = [&](double from, double to) {
        return std::pow(10.0, from + (to - from) * double(rng.next_float()));
    };
    double worst = 0.0;
    for (int i = 0; i < 400; ++i) {
        const double scale = power(-6, 6), g = i % 3 == 0
                                                   ? 0.0
                                                   : (i % 3 == 1 ? 1.98 * (double(rng.next_float()) - 0.5)
                                                                 : (i % 2 ? 0.99 : -0.99));
        const double nearest = 3.0 * scale * (2.0 * double(rng.next_float()) - 1.0);
        const double t0 = i % 2 ? 0.0 : scale * double(rng.next_float());
        const double t1 = i % 10 == 0 ? double(infinity) : t0 + scale * power(-6, 2);
        const Case c = {passing(nearest, scale * power(-5, 2)), t0, t1,
                        i % 7 == 0 ? 0.0 : power(-4, 2) / scale, g};
        const double error = relative_error(c);
        worst = std::max(worst, error);
        CHECK(error < accuracy);
    }
    INFO(worst);
    CHECK(worst > 0.0);
}

TEST_CASE("Air light at the extremes", "[airlight]") {
    const double inf = double(infinity);
    for (const double g : {0.0, 0.99, -0.99})
        for (const double sigma_t : {0.0, 1e-30, 1e-6, 1.0, 1e3, 1e6}) {
            CHECK(relative_error({passing(5.0, 1e-5), 0.0, 10.0, sigma_t, g}) <
                  accuracy);  // through the light
            CHECK(relative_error({passing(0.0, 1e-30), 1e-3, 1.0, sigma_t, g}) < accuracy);  // away from it
            CHECK(relative_error({passing(1.0, 1.0), 0.0, 1e-6, sigma_t, g}) < accuracy);
            CHECK(relative_error({passing(1.0, 1.0), 0.0, 1e6, sigma_t, g}) < accuracy);
            CHECK(relative_error({passing(1.0, 1.0), 0.0, inf, sigma_t, g}) < accuracy);
            CHECK(relative_error({passing(1e6, 1e6), 0.0, inf, sigma_t, g}) < accuracy);
            CHECK(relative_error({passing(-1e6, 1.0), 0.0, 1.0, sigma_t, g}) < accuracy);
            CHECK(airlight(passing(1.0, 1.0), 2.0, 2.0, sigma_t, g) == 0.0);
            // The light at the eye, with nothing between: large, finite, and of the right order.
            const double at_eye = airlight(PassingRay(Ray{}, Vec3(0.0f)), 0.0, 1.0, sigma_t, g);
            CHECK(std::isfinite(at_eye));
            CHECK(at_eye > 1e22);
        }
    CHECK(airlight(passing(1.0, 1.0), 0.0, 1.0, 1e30, 0.5) == 0.0);
    CHECK(airlight(passing(0.0, 1e-30), 1.0, 2.0, 0.0, 0.0) ==
          Approx(0.5 / (4.0 * std::numbers::pi)).epsilon(accuracy));
}

TEST_CASE("The quadrature would find errors of the air light", "[airlight]") {
    const Case c = {passing(1.0, 0.5), 0.0, 4.0, 0.7, 0.4};
    const double expected = quadrature(c);
    const auto wrong = [&](double value) { return std::abs(value / expected - 1.0) > 1e-3; };
    CHECK_FALSE(wrong(airlight(c.ray, c.t0, c.t1, c.sigma_t, c.g)));
    CHECK(wrong(airlight(c.ray, c.t0, c.t1, c.sigma_t, -c.g)));        // scattered backwards
    CHECK(wrong(airlight(c.ray, c.t0, c.t1, 1.01 * c.sigma_t, c.g)));  // a hundredth too dense
    CHECK(wrong(airlight(passing(1.0, 0.51), c.t0, c.t1, c.sigma_t, c.g)));
}

TEST_CASE("Air light of a varying intensity", "[airlight]") {
    const PassingRay ray = passing(1.0, 0.5);
    // Pieces of constant intensities add up.
    const auto two = [](double) { return 2.0; };
    CHECK(airlight(ray, 0.0, 4.0, 0.7, 0.4, two) ==
          Approx(2.0 * airlight(ray, 0.0, 4.0, 0.7, 0.4)).epsilon(accuracy));
    // exp(k t) is a change of the extinction along the ray, not towards the light: so is checked by a sum.
    const auto falling = [](double t) { return std::exp(-0.5 * t); };
    double sum = 0.0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const double a = 4.0 * i / n, b = 4.0 * (i + 1) / n;
        sum += falling(0.5 * (a + b)) * std::exp(-0.7 * a) * airlight(ray, a, b, 0.7, 0.4);
    }
    CHECK(airlight(ray, 0.0, 4.0, 0.7, 0.4, falling) == Approx(sum).epsilon(1e-6));
}
