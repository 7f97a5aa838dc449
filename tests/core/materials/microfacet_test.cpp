// Properties that define a distribution of microfacet normals (Heitz 2014), by quadrature.
#include "core/materials/microfacet.h"

#include "core/materials/fresnel.h"
#include "core/materials/rough_transmittance.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"

using namespace mote::core;
using mote::tests::direction_at;

namespace {

/// The integral of f(m) over the upper hemisphere, with slopes on a polar grid: m = (-x, -y, 1) normalised,
/// dm = dx dy cos^3. r = alpha tan(t) resolves the distribution at every roughness.
template <typename F>
double integrate_normals(const Microfacet& d, F f) {
    constexpr int rings = 800, spokes = 128;
    const double half_pi = 1.5707963267948966;
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        const double t = (i + 0.5) / rings * half_pi, r = std::tan(t);
        for (int j = 0; j < spokes; ++j) {
            const double phi = (j + 0.5) / spokes * 4.0 * half_pi;
            const double x = double(d.alpha_u()) * r * std::cos(phi),
                         y = double(d.alpha_v()) * r * std::sin(phi);
            const double c = 1.0 / std::sqrt(1.0 + x * x + y * y);
            const Vec3 m(float(-x * c), float(-y * c), float(c));
            sum += f(m) * c * c * c * r * (1.0 + r * r);
        }
    }
    return sum * double(d.alpha_u()) * double(d.alpha_v()) * (half_pi / rings) * (4.0 * half_pi / spokes);
}

std::vector<Microfacet> distributions() {
    std::vector<Microfacet> all;
    for (const MicrofacetKind kind : {MicrofacetKind::beckmann, MicrofacetKind::ggx})
        for (const auto& [u, v] : {std::pair{1e-4f, 1e-4f},
                                   {0.01f, 0.01f},
                                   {0.1f, 0.1f},
                                   {0.5f, 0.5f},
                                   {1.0f, 1.0f},
                                   {0.05f, 0.4f},
                                   {0.7f, 0.2f},
                                   {3.0f, 3.0f}})
            all.emplace_back(kind, u, v);
    return all;
}

}  // namespace

TEST_CASE("facets project to the unit area of the surface", "[materials][microfacet]") {
    for (const Microfacet& d : distributions()) {
        CAPTURE(int(d.kind()), d.alpha_u(), d.alpha_v());
        CHECK(integrate_normals(d, [&](const Vec3& m) { return double(d.density(m) * m.z); }) ==
              Approx(1.0).epsilon(2e-3));
    }
}

TEST_CASE("visible normals are a density, at every angle", "[materials][microfacet]") {
    for (const Microfacet& d : distributions())
        for (const double cosine : {1.0, 0.7, 0.3, 0.05}) {
            const Vec3 wo = direction_at(cosine, 0.6);
            CAPTURE(int(d.kind()), d.alpha_u(), d.alpha_v(), cosine);
            CHECK(integrate_normals(d, [&](const Vec3& m) { return double(d.pdf_visible(wo, m)); }) ==
                  Approx(1.0).epsilon(4e-3));
        }
}

TEST_CASE("sampled visible normals have the mean of their density", "[materials][microfacet]") {
    // A direct test of sample_visible() beside the chi-square tests of the BSDFs: the mean slopes, with sigma
    // from the samples. Slopes of GGX have no variance: they are squashed by x / (1 + |x|).
    const auto squash = [](double x) { return x / (1.0 + std::fabs(x)); };
    for (const Microfacet& d : distributions())
        for (const double cosine : {1.0, 0.7, 0.3, 0.05}) {
            const Vec3 wo = direction_at(cosine, 0.6);
            Rng rng(17);
            constexpr int n = 20000;
            double sum = 0.0, squares = 0.0;
            const auto value = [&](const Vec3& m) {
                return squash(-double(m.x) / double(m.z) / double(d.alpha_u())) +
                       0.5 * squash(-double(m.y) / double(m.z) / double(d.alpha_v()));
            };
            for (int i = 0; i < n; ++i) {
                const Vec3 m = d.sample_visible(wo, rng.next_vec2());
                REQUIRE((is_finite(m) && m.z > 0.0f && glm::dot(m, wo) > -1e-6f));
                const double v = value(m);
                sum += v, squares += v * v;
            }
            const double mean = sum / n, sigma = std::sqrt((squares / n - mean * mean) / n);
            const double expected =
                integrate_normals(d, [&](const Vec3& m) { return double(d.pdf_visible(wo, m)) * value(m); });
            CAPTURE(int(d.kind()), d.alpha_u(), d.alpha_v(), cosine, mean, expected, sigma);
            CHECK(std::fabs(mean - expected) < 4.5 * sigma + 4e-3 * std::fabs(expected));
        }
}

TEST_CASE("masking lies between 0 and 1 and is 1 from straight above", "[materials][microfacet]") {
    for (const Microfacet& d : distributions()) {
        CHECK(d.masking({0.0f, 0.0f, 1.0f}) == Approx(1.0f));
        float previous = 1.0f;
        for (const double cosine : {0.9, 0.5, 0.1, 1e-2, 1e-4, 1e-8, 1e-30}) {
            const float g = d.masking(direction_at(cosine, 0.4));
            CHECK((g > 0.0f && g <= previous + 1e-6f));
            previous = g;
        }
    }
}

TEST_CASE("a smooth limit of the rough tables", "[materials][microfacet]") {
    const Microfacet smooth(MicrofacetKind::beckmann, 1e-4f);
    for (const float mu : {1.0f, 0.8f, 0.5f, 0.2f})
        CHECK(rough_reflectance(smooth, 1.5f, mu) ==
              Approx(double(fresnel_dielectric(mu, 1.5f).reflectance)).epsilon(1e-3));
    // The sum over 64 equidistant cosines is 63/64 of the integral by the trapezoidal rule, and R(1) / 64 too
    // much.
    const double normal = double(fresnel_dielectric(1.0f, 1.5f).reflectance);
    CHECK(double(rough_internal_reflectance(smooth, 1.5f)) ==
          Approx(fresnel_diffuse_reflectance(1.0 / 1.5) * 63.0 / 64.0 + normal / 64.0).epsilon(5e-3));
    for (const LostLight lost : {LostLight::absorbed, LostLight::transmitted})
        CHECK(1.0 - double(RoughTransmittance(smooth, 1.5f, lost).mean()) ==
              Approx(fresnel_diffuse_reflectance(1.5)).epsilon(2e-2));
}

TEST_CASE("light that meets a second facet is lost, or transmitted", "[materials][microfacet]") {
    for (const MicrofacetKind kind : {MicrofacetKind::beckmann, MicrofacetKind::ggx})
        for (const float alpha : {0.1f, 0.4f, 1.0f}) {
            const Microfacet facets(kind, alpha);
            const RoughTransmittance absorbed(facets, 1.5f, LostLight::absorbed),
                transmitted(facets, 1.5f, LostLight::transmitted);
            for (const float mu : {1.0f, 0.8f, 0.5f, 0.2f, 0.05f}) {
                const double r = rough_reflectance(facets, 1.5f, mu),
                             t = rough_transmittance(facets, 1.5f, mu);
                CAPTURE(int(kind), alpha, mu, r, t);
                CHECK((r > 0.0 && t > 0.0 && r + t <= 1.0 + 1e-6));
                CHECK(double(absorbed(mu)) == Approx(t).epsilon(5e-3));
                if (mu > 0.1f) CHECK(double(transmitted(mu)) == Approx(1.0 - r).epsilon(5e-3));
            }
            // Refraction is reciprocal: T(1/eta) eta^2 = T(eta), both under uniform light.
            const RoughTransmittance inside(facets, 1.0f / 1.5f, LostLight::absorbed);
            CHECK(double(inside.mean()) * 2.25 == Approx(double(absorbed.mean())).epsilon(0.02));
        }
}

TEST_CASE("smaller roughness than single precision resolves is raised", "[materials][microfacet]") {
    CHECK(Microfacet(MicrofacetKind::ggx, 0.0f).alpha_u() == Microfacet::smallest_alpha);
}
