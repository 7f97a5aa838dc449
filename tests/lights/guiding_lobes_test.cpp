// Lobes and mixtures of guided paths: densities, samples, products, and the extremes of their concentration.
#include "lights/guiding/vmf_mixture.h"

#include "core/math/random.h"
#include "core/math/warp.h"
#include "lights/guiding/scattering_guide.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"
#include "tests/support/mean_of.h"

using namespace mote;
using namespace mote::core;
using namespace mote::lights;
using namespace mote::tests;

namespace {

Vec3 direction(Rng& rng) { return glm::normalize(square_to_sphere(rng.next_vec2())); }

/// Integral of f over the sphere, in rings around `axis` that are narrow where 1 - cos is small.
template <typename F>
double integral(const Vec3& axis, const F& f) {
    const Frame frame(axis);
    const int rings = 4000, around = 64;
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        // h = 1 - cos = 2 s^6: its rings reach down to 1e-21
        const double s = (i + 0.5) / rings, h = 2.0 * std::pow(s, 6.0), dh = 12.0 * std::pow(s, 5.0) / rings;
        const double sine = std::sqrt(h * (2.0 - h));
        for (int j = 0; j < around; ++j) {
            const double phi = 2.0 * 3.14159265358979 * (j + 0.5) / around;
            const Vec3 w(float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(1.0 - h));
            sum += double(f(glm::normalize(frame.to_world(w)))) * dh * 2.0 * 3.14159265358979 / around;
        }
    }
    return sum;
}

VmfMixture some_mixture(Rng& rng, float kappa) {
    VmfMixture m = even_mixture();
    for (int k = 0; k < VmfMixture::capacity; ++k)
        m.set(k, {direction(rng), kappa * (0.5f + rng.next_float())}, float(k + 1) / 36.0f);
    return m;
}

void check_mixture(const VmfMixture& m, const char* name, double planted, bool passes) {
    Chi2Options options;
    options.name = name, options.samples = 200000, options.tests = 4, options.subdivisions = 3;
    options.write_table = passes;
    const Chi2Result result = chi2_test(
        [&](Rng& rng) -> std::optional<Vec3> {
            const float u = rng.next_float();
            return m.sample(u, rng.next_vec2());
        },
        [&](const Vec3& w) { return planted * double(m.pdf_solid_angle(w)); }, options);
    INFO(result.message);
    CHECK(result.passed == passes);
}

}  // namespace

TEST_CASE("exp_of_negative is the exponential to rounding", "[guiding]") {
    CHECK(exp_of_negative(0.0f) == 1.0f);
    double worst = 0.0;
    for (float x = 0.0f; x > -80.0f; x -= 0.00731f)
        worst = std::max(worst, std::fabs(double(exp_of_negative(x)) / std::exp(double(x)) - 1.0));
    CHECK(worst < 3e-7);
    CHECK(exp_of_negative(-1e30f) < 1e-37f);
}

TEST_CASE("A lobe's density integrates to one at every concentration", "[guiding]") {
    Rng rng(1);
    for (const float kappa : {0.0f, 1e-6f, 1e-3f, 0.049f, 0.051f, 1.0f, 30.0f, 1e3f, 1e4f}) {
        const VmfLobe lobe{direction(rng), kappa};
        INFO("kappa " << kappa);
        CHECK(integral(lobe.mean, [&](const Vec3& w) { return lobe.pdf_solid_angle(w); }) ==
              Approx(1.0).epsilon(2e-3));
    }
}

TEST_CASE("A lobe's samples have its mean cosine, up to a concentration of 1e6", "[guiding]") {
    Rng rng(2);
    for (const float kappa : {0.0f, 1e-5f, 1e-3f, 0.3f, 5.0f, 200.0f, 1e4f, 1e6f}) {
        const VmfLobe lobe{direction(rng), kappa};
        const Mean deviation = mean_of(40000, [&] {
            const Vec3 w = lobe.sample(rng.next_vec2());
            REQUIRE(std::fabs(glm::length(w) - 1.0f) < 1e-5f);
            REQUIRE(lobe.pdf_solid_angle(w) > 0.0f);
            const Vec3 d = w - lobe.mean;
            return 0.5 * double(glm::dot(d, d));  // 1 - cos
        });
        INFO("kappa " << kappa);
        const double expected = 1.0 - mean_cosine_of_kappa(double(kappa));
        CHECK(std::fabs(deviation.mean - expected) < 4.5 * deviation.error + 1e-3 * expected);
    }
    const VmfLobe narrow{{0, 0, 1}, max_kappa};
    for (const Vec2& u : {Vec2(0.0f), Vec2(one_minus_epsilon), Vec2(0.0f, one_minus_epsilon)}) {
        const Vec3 w = narrow.sample(u);
        CHECK(is_finite(w));
        CHECK(std::isfinite(narrow.pdf_solid_angle(w)));
    }
}

TEST_CASE("The concentration follows from the mean cosine", "[guiding]") {
    for (const double kappa : {1e-3, 0.1, 1.0, 10.0, 1e3, 1e5})
        CHECK(double(kappa_of_mean_cosine(mean_cosine_of_kappa(kappa))) == Approx(kappa).epsilon(0.06));
    CHECK(kappa_of_mean_cosine(1.0) == max_kappa);
    CHECK(kappa_of_mean_cosine(0.0) == 0.0f);
}

TEST_CASE("The product of two lobes is a lobe with the integral of their product", "[guiding]") {
    Rng rng(3);
    for (const float a : {0.0f, 0.02f, 2.0f, 300.0f})
        for (const float b : {0.0f, 1.0f, 40.0f, 2000.0f}) {
            const VmfLobe first{direction(rng), a};
            const Vec3 near = glm::normalize(first.mean + 0.1f * direction(rng));
            const VmfLobe second{b > 100.0f ? near : direction(rng), b};
            const VmfProduct p = product(first, second);
            INFO("kappa " << a << " and " << b);
            const auto f = [&](const Vec3& w) {
                return first.pdf_solid_angle(w) * second.pdf_solid_angle(w);
            };
            CHECK(integral(p.lobe.mean, f) == Approx(double(p.integral)).epsilon(4e-3).margin(1e-12));
            const Vec3 w = p.lobe.sample({0.4f, 0.3f});
            CHECK(f(w) == Approx(p.integral * p.lobe.pdf_solid_angle(w)).epsilon(2e-3).margin(1e-12));
        }
    // At the same mean nothing cancels, however narrow both are: c^2 / c(2 kappa) = kappa / (4 pi).
    const VmfLobe narrow{direction(rng), 1e6f};
    CHECK(double(product(narrow, narrow).integral) == Approx(1e6 / (4.0 * 3.14159265358979)).epsilon(1e-4));
    const VmfLobe opposite{-narrow.mean, 1e6f};
    CHECK(product(narrow, opposite).integral < 1e-20f);
    CHECK(is_finite(product(narrow, opposite).lobe.mean));
}

TEST_CASE("A mixture times a lobe is the normalised product of densities", "[guiding]") {
    Rng rng(4);
    const VmfMixture m = some_mixture(rng, 6.0f);
    for (const VmfLobe& lobe : {cosine_lobe({0, 0, 1}), phase_lobe({0, 1, 0}, 0.8f),
                                phase_lobe({0, 1, 0}, -0.3f), phase_lobe({0, 1, 0}, 0.0f)}) {
        VmfMixture both = m;
        both.multiply(lobe);
        REQUIRE_FALSE(both.empty);
        const double total = integral(
            lobe.mean, [&](const Vec3& w) { return m.pdf_solid_angle(w) * lobe.pdf_solid_angle(w); });
        for (int i = 0; i < 50; ++i) {
            const Vec3 w = direction(rng);
            CHECK(both.pdf_solid_angle(w) ==
                  Approx(m.pdf_solid_angle(w) * lobe.pdf_solid_angle(w) / total).epsilon(5e-3));
        }
    }
    VmfMixture narrow = m;
    for (int k = 0; k < VmfMixture::capacity; ++k) narrow.set(k, {{0, 0, 1}, 1e6f}, 0.125f);
    narrow.multiply({{0, 0, -1}, 1e6f});  // nothing in common: whatever is left is finite
    if (!narrow.empty) CHECK(std::isfinite(narrow.pdf_solid_angle({0, 0, 1})));
}

TEST_CASE("Mixtures are sampled as their density says", "[guiding][chi2]") {
    Rng rng(5);
    const VmfMixture wide = some_mixture(rng, 3.0f), narrow = some_mixture(rng, 25.0f);
    check_mixture(wide, "wide mixture", 1.0, true);
    check_mixture(narrow, "narrow mixture", 1.0, true);
    VmfMixture times_cosine = wide;
    times_cosine.multiply(cosine_lobe({0.6f, 0.0f, 0.8f}));
    check_mixture(times_cosine, "mixture times a cosine", 1.0, true);
    check_mixture(wide, "planted density", 1.05, false);
    // Weights that belong to other lobes.
    VmfMixture wrong = wide;
    std::swap(wrong.weight[0], wrong.weight[7]);
    Chi2Options options;
    options.samples = 200000, options.write_table = false;
    CHECK_FALSE(chi2_test(
                    [&](Rng& r) -> std::optional<Vec3> {
                        const float u = r.next_float();
                        return wide.sample(u, r.next_vec2());
                    },
                    [&](const Vec3& w) { return double(wrong.pdf_solid_angle(w)); }, options)
                    .passed);
}

TEST_CASE("A guided density is that of both techniques together", "[guiding]") {
    Rng rng(6);
    const VmfMixture m = some_mixture(rng, 3.0f);
    const Vec3 w = direction(rng);
    const float p = guide_probability, lobes = m.pdf_solid_angle(w);
    CHECK(guided_pdf(m, w, 0.3f) == Approx(0.3f * (1.0f - p) + p * lobes));
    CHECK(guided_pdf(m, w, 0.0f, 2.0f) == Approx(2.0f * p * lobes));
    CHECK(guided_pdf(VmfMixture{}, w, 0.3f) == 0.3f);
}
