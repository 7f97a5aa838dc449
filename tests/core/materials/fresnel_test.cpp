// Fresnel reflectances against closed forms and published values.
#include "core/materials/fresnel.h"

#include <complex>

#include "core/materials/index_of_refraction.h"
#include "tests/support/catch.h"

using namespace mote::core;

TEST_CASE("dielectric reflectance at special angles", "[materials][fresnel]") {
    for (const float eta : {1.000277f, 1.333f, 1.5f, 2.419f, 0.6667f, 10.0f, 0.1f}) {
        const float normal = sqr((eta - 1.0f) / (eta + 1.0f));
        CHECK(fresnel_dielectric(1.0f, eta).reflectance == Approx(normal).epsilon(1e-4));
        CHECK(fresnel_dielectric(0.0f, eta).reflectance == 1.0f);
        // At Brewster's angle, tan = eta, only the perpendicular part is left: ((eta^2-1)/(eta^2+1))^2 / 2.
        const float cosine = 1.0f / std::sqrt(1.0f + eta * eta), e2 = eta * eta;
        CHECK(fresnel_dielectric(cosine, eta).reflectance ==
              Approx(0.5f * sqr((e2 - 1.0f) / (e2 + 1.0f))).epsilon(1e-3));
    }
    CHECK(fresnel_dielectric(1e-3f, 1.0f).reflectance == 0.0f);
    CHECK(fresnel_dielectric(0.0f, 1.0f).reflectance == 0.0f);
    CHECK(fresnel_dielectric(0.5f, 0.6667f).reflectance == 1.0f);  // total internal reflection
    CHECK(fresnel_dielectric(0.5f, 0.6667f).cos_t == 0.0f);
}

TEST_CASE("reflectance is the same from both sides along one path", "[materials][fresnel]") {
    for (int i = 1; i <= 100; ++i) {
        const float cosine = float(i) / 100.0f;
        const auto down = fresnel_dielectric(cosine, 1.5f);
        const auto up = fresnel_dielectric(down.cos_t, 1.0f / 1.5f);
        CHECK(up.reflectance == Approx(down.reflectance).epsilon(1e-4));
        CHECK(up.cos_t == Approx(cosine).epsilon(1e-4).margin(5e-5));
    }
}

TEST_CASE("conductor reflectance equals the complex formula", "[materials][fresnel]") {
    const auto reference = [](double cosine, std::complex<double> n) {
        const double sin2 = 1.0 - cosine * cosine;
        const std::complex<double> root = std::sqrt(n * n - sin2);
        const auto s = (cosine - root) / (cosine + root),
                   p = (n * n * cosine - root) / (n * n * cosine + root);
        return 0.5 * (std::norm(s) + std::norm(p));
    };
    for (const double eta : {0.0, 0.05, 0.2, 1.0, 1.5, 4.4, 50.0})
        for (const double k : {0.0, 1e-3, 0.5, 2.0, 9.2, 100.0})
            for (const double cosine : {1.0, 0.9, 0.5, 0.1, 1e-3}) {
                if (k == 0.0 && eta <= 1.0) continue;  // no metal: total reflection, tested above
                CAPTURE(eta, k, cosine);
                CHECK(double(fresnel_conductor(float(cosine), float(eta), float(k))) ==
                      Approx(reference(cosine, {eta, k})).epsilon(1e-3).margin(1e-5));
            }
    for (const float cosine : {0.0f, 1e-6f, 0.3f, 1.0f})
        CHECK(fresnel_conductor(cosine, 0.0f, 1.0f) == 1.0f);  // the perfect mirror is exact
    CHECK(fresnel_conductor(0.0f, 0.2f, 3.9f) == Approx(1.0f));
    CHECK(fresnel_conductor(0.7f, 1.0f, 0.0f) < 1e-7f);
    CHECK(is_finite(fresnel_conductor(1.0f, 0.0f, 0.0f)));
}

TEST_CASE("mean reflectance under uniform light", "[materials][fresnel]") {
    // Walsh's closed form as quoted by Duntley 1942, in double precision.
    const auto walsh = [](double n) {
        const double n2 = n * n, n4 = n2 * n2;
        return 0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0)) +
               n2 * (n2 - 1.0) * (n2 - 1.0) / std::pow(n2 + 1.0, 3.0) * std::log((n - 1.0) / (n + 1.0)) -
               2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0)) +
               8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0) * (n4 - 1.0)) * std::log(n);
    };
    for (const double eta : {1.1, 1.333, 1.49, 1.5046, 2.419})
        CHECK(fresnel_diffuse_reflectance(eta) == Approx(walsh(eta)).epsilon(1e-5));
    // From inside: reciprocity, and a direct sum over angles as a check of it.
    double sum = 0.0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
        const double mu = (i + 0.5) / n;
        sum += 2.0 * mu * fresnel_dielectric(mu, 1.0 / 1.5).reflectance / n;
    }
    CHECK(fresnel_diffuse_reflectance(1.0 / 1.5) == Approx(sum).epsilon(1e-5));
    CHECK(fresnel_diffuse_reflectance(1.0) == Approx(0.0).margin(1e-12));
}

TEST_CASE("refraction obeys Snell's law", "[materials][fresnel]") {
    const Vec3 m = glm::normalize(Vec3(0.2f, -0.1f, 1.0f)), w = glm::normalize(Vec3(0.5f, 0.3f, 0.6f));
    for (const float eta : {1.5f, 0.9f}) {
        const float cosine = glm::dot(w, m);
        const Vec3 t = refract(w, m, cosine, fresnel_dielectric(cosine, eta).cos_t, eta);
        CHECK(glm::length(t) == Approx(1.0f).epsilon(1e-5));
        CHECK(glm::length(glm::cross(t, m)) * eta == Approx(glm::length(glm::cross(w, m))).epsilon(1e-5));
        CHECK(glm::dot(t, m) < 0.0f);
        CHECK(std::fabs(glm::dot(glm::cross(t, m), w)) < 1e-6f);
    }
}

TEST_CASE("materials by name", "[materials][fresnel]") {
    CHECK(dielectric_index("bk7") == 1.5046f);
    CHECK(dielectric_index("BK7") == 1.5046f);
    CHECK(dielectric_index("air") == 1.000277f);
    CHECK(dielectric_index("water") == 1.333f);
    CHECK(dielectric_index("diamond") == 2.419f);
    CHECK_FALSE(dielectric_index("butter"));
    const auto copper = conductor_index("Cu"), gold = conductor_index("Au"), silver = conductor_index("Ag");
    REQUIRE((copper && gold && silver && conductor_index("Al") && conductor_index("none")));
    const Rgb c = fresnel_conductor(1.0f, copper->eta, copper->k),
              g = fresnel_conductor(1.0f, gold->eta, gold->k);
    CHECK((c.x > c.y && c.y > c.z && g.x > g.y && g.y > g.z));  // reddish, yellowish
    CHECK(min_component(fresnel_conductor(1.0f, silver->eta, silver->k)) > 0.85f);
    CHECK_FALSE(conductor_index("cu"));
    // Amorphous carbon, and names that end in "_palik" where Mitsuba has them: sometimes a second
    // measurement.
    REQUIRE((conductor_index("a-C") && conductor_index("d-C_palik") && conductor_index("Na_palik")));
    CHECK(conductor_index("Be_palik")->eta == conductor_index("Be")->eta);
    CHECK(conductor_index("Cu_palik")->eta != copper->eta);
    for (const char* unknown : {"Ag_palik", "a-C_palik", "Na", "_palik", "", "A-C"})
        CHECK_FALSE(conductor_index(unknown));
}
