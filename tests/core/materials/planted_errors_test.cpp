// The chi-square test has power: typical mistakes, planted on purpose, are found.
#include "core/math/warp.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"

using namespace mote;
using namespace mote::tests;
using core::TransportMode;
using core::Vec3;

namespace {

const core::BsdfPoint point{};

Chi2Options options(std::size_t samples = 160000) {
    Chi2Options o;
    o.samples = samples;
    o.tests = 150;  // as strict, or lenient, as within the family of all BSDFs
    o.write_table = false;
    return o;
}

DirectionSampler sampler_of(const core::BsdfPtr& bsdf, const Vec3& wo) {
    return [bsdf, wo](core::Rng& rng) -> std::optional<Vec3> {
        const auto s = sample(*bsdf, wo, rng, TransportMode::radiance);
        if (!s || s->delta) return std::nullopt;
        return s->wi;
    };
}

DirectionDensity density_of(const core::BsdfPtr& bsdf, const Vec3& wo, double factor = 1.0) {
    return [=](const Vec3& wi) {
        return factor * double(bsdf->pdf_solid_angle(point, wo, wi, TransportMode::radiance));
    };
}

const Vec3 wo = direction_at(0.7, 0.5);

}  // namespace

TEST_CASE("the unharmed pair passes with the options of the planted errors", "[materials][chi2][planted]") {
    for (const core::BsdfPtr& bsdf : {core::BsdfPtr(core::make_diffuse()),
                                      core::BsdfPtr(core::make_rough_conductor(gold(), beckmann(0.3f)))}) {
        const Chi2Result result = chi2_test(sampler_of(bsdf, wo), density_of(bsdf, wo), options(1000000));
        INFO(result.message);
        CHECK(result.passed);
    }
}

TEST_CASE("a dropped cosine is found", "[materials][chi2][planted]") {
    const core::BsdfPtr diffuse = core::make_diffuse();
    const auto uniform = [](const Vec3& w) { return w.z > 0.0f ? double(core::inv_two_pi) : 0.0; };
    CHECK_FALSE(chi2_test(sampler_of(diffuse, wo), uniform, options()).passed);
}

TEST_CASE("a density off by two percent is found", "[materials][chi2][planted]") {
    for (const core::BsdfPtr& bsdf :
         {core::BsdfPtr(core::make_diffuse()), core::BsdfPtr(core::make_rough_conductor(gold(), ggx(0.2f))),
          core::BsdfPtr(core::make_plastic({}))})
        for (const double factor : {0.98, 1.02}) {
            const Chi2Result result =
                chi2_test(sampler_of(bsdf, wo), density_of(bsdf, wo, factor), options());
            INFO(result.message);
            CHECK_FALSE(result.passed);
        }
}

TEST_CASE("a chance of choosing a lobe off by two percent is found", "[materials][chi2][planted]") {
    // The density stays normalised: only the probabilities of the two lobes are wrong (0.50 for 0.48).
    const core::BsdfPtr phong = core::make_phong({20.0f, grey(0.4f), grey(0.4f)});
    const core::BsdfPtr wrong = core::make_phong({20.0f, grey(0.4f), grey(0.4f * 0.48f / 0.52f)});
    const Vec3 normal(0.0f, 0.0f, 1.0f);
    CHECK_FALSE(chi2_test(sampler_of(phong, normal), density_of(wrong, normal), options(1000000)).passed);
}

TEST_CASE("a lobe shifted by a degree is found", "[materials][chi2][planted]") {
    const core::BsdfPtr metal = core::make_rough_conductor(gold(), beckmann(0.3f));
    const auto straight = sampler_of(metal, wo);
    const double c = std::cos(0.0174533), s = std::sin(0.0174533);
    const auto shifted = [&](core::Rng& rng) -> std::optional<Vec3> {
        const auto w = straight(rng);
        if (!w) return w;
        return Vec3(float(c * double(w->x) - s * double(w->y)), float(s * double(w->x) + c * double(w->y)),
                    w->z);
    };
    CHECK_FALSE(chi2_test(shifted, density_of(metal, wo), options()).passed);
}

TEST_CASE("samples where the density is zero are found", "[materials][chi2][planted]") {
    const core::BsdfPtr diffuse = core::make_diffuse();
    const auto straight = sampler_of(diffuse, wo);
    const auto stray = [&](core::Rng& rng) -> std::optional<Vec3> {
        const auto w = straight(rng);
        return rng.next_float() < 1e-4f && w ? std::optional<Vec3>(-*w) : w;
    };
    CHECK_FALSE(chi2_test(stray, density_of(diffuse, wo), options()).passed);
}

TEST_CASE("roughness off by three percent is found", "[materials][chi2][planted]") {
    const core::BsdfPtr metal = core::make_rough_conductor(gold(), ggx(0.3f));
    const core::BsdfPtr wrong = core::make_rough_conductor(gold(), ggx(0.309f));
    CHECK_FALSE(chi2_test(sampler_of(metal, wo), density_of(wrong, wo), options(1000000)).passed);
}
