// Every BSDF with a smooth part draws directions with the density it claims.
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"

using namespace mote;
using namespace mote::tests;
using core::TransportMode;
using core::Vec3;

namespace {

const core::BsdfPoint point{};

/// Normal incidence, moderate, steep and grazing; from above and from below.
const std::vector<Vec3> views = {direction_at(1.0, 0.0),  direction_at(0.8, 0.7),  direction_at(0.3, 4.0),
                                 direction_at(0.02, 2.5), direction_at(-0.9, 1.0), direction_at(-0.2, 5.0)};

int test_count() { return int(smooth_cases().size() * views.size()); }

Chi2Result run(const BsdfCase& c, const Vec3& wo, std::size_t view) {
    Chi2Options options;
    options.name = c.name + "_" + std::to_string(view);
    options.seed = core::hash_keys(0x636869ull, view, c.name.size());
    options.tests = test_count();
    if (c.narrow > 0.0f) {  // cells over a cap of a few widths around the mirror direction
        options.frame = core::Frame(core::reflect_local(wo));
        options.cap = std::min(2.0, 8.0 * double(c.narrow) * double(c.narrow));
        options.subdivisions = 3;  // seen at grazing angles, the lobe is a thin blade across the cells
    }
    const auto sampler = [&](core::Rng& rng) -> std::optional<Vec3> {
        const auto s = draw(*c.bsdf, wo, rng, TransportMode::radiance);
        if (!s || s->delta) return std::nullopt;
        return s->wi;
    };
    const auto density = [&](const Vec3& wi) {
        return double(c.bsdf->pdf_solid_angle(point, wo, wi, TransportMode::radiance));
    };
    return chi2_test(sampler, density, options);
}

}  // namespace

TEST_CASE("sampling agrees with its density by a chi-square test", "[materials][bsdf][chi2]") {
    for (const BsdfCase& c : smooth_cases()) {
        for (std::size_t v = 0; v < views.size(); ++v) {
            const auto probe = c.bsdf->sample(point, views[v], 0.99f, {0.4f, 0.3f}, TransportMode::radiance);
            const bool one_sided = views[v].z < 0.0f && !c.bsdf->traits().transmissive && !probe;
            if (one_sided) continue;  // black from behind: another test says so
            const Chi2Result result = run(c, views[v], v);
            INFO(result.message);
            CHECK(result.passed);
            CHECK(result.integral <= 1.001);
        }
    }
}

TEST_CASE("the tail of the chi-square distribution", "[chi2]") {
    // Abramowitz & Stegun 1964, table 26.8.
    CHECK(chi2_survival(3.841459, 1) == Approx(0.05).epsilon(1e-5));
    CHECK(chi2_survival(18.307038, 10) == Approx(0.05).epsilon(1e-5));
    CHECK(chi2_survival(149.448990, 100) == Approx(0.001).epsilon(2e-3));
    CHECK(chi2_survival(0.0, 5) == 1.0);
}
