// Every BSDF with a smooth part samples directions with the density it claims, for the eye and for the light,
// and the density that a vertex gives for the way back is that of the paths that go it.
#include "core/scene/reverse_density.h"
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

int test_count() { return int(2 * smooth_cases().size() * views.size()); }

Chi2Options options_of(const BsdfCase& c, const Vec3& wo, std::size_t view, TransportMode mode) {
    Chi2Options options;
    options.name = c.name + "_" + std::to_string(view);
    options.seed =
        core::hash_keys(mode == TransportMode::radiance ? 0x636869ull : 0x6c69ull, view, c.name.size());
    options.tests = test_count();
    if (c.narrow > 0.0f) {  // cells over a cap of a few widths around the mirror direction
        options.frame = core::Frame(core::reflect_local(wo));
        options.cap = std::min(2.0, 8.0 * double(c.narrow) * double(c.narrow));
        options.subdivisions = 3;  // seen at grazing angles, the lobe is a thin blade across the cells
    }
    if (c.bent) options.subdivisions = 2;  // light below the horizon of one normal is cut off within cells
    return options;
}

DirectionSampler sampler_of(const BsdfCase& c, const Vec3& wo, TransportMode mode) {
    return [&c, wo, mode](core::Rng& rng) -> std::optional<Vec3> {
        const auto s = sample(*c.bsdf, wo, rng, mode);
        if (!s || s->delta) return std::nullopt;
        return s->wi;
    };
}

/// The density of directions w of light paths that come from `from`, as that of eye paths that come from
/// w and continue to `from`: at a vertex turned away from the axes.
DirectionDensity reverse_density(const BsdfCase& c, const Vec3& from) {
    core::ScatteringVertex vertex;
    vertex.bsdf = c.bsdf.get();
    vertex.hit.shading = core::Frame(glm::normalize(Vec3(0.3f, -0.5f, 0.6f)));
    vertex.hit.geometric_normal = vertex.hit.shading.n;
    return [vertex, from](const Vec3& w) mutable {
        vertex.wo = vertex.hit.shading.to_world(w);
        return double(core::reverse_pdf_solid_angle(vertex, vertex.hit.shading.to_world(from),
                                                    TransportMode::radiance));
    };
}

/// Do paths of light sample what eye paths sample, to the bit, and is the density of the way back that of the
/// way there, where they go and anywhere else? Then the test of eye paths is theirs, too.
bool same_both_ways(const BsdfCase& c, const Vec3& from, const DirectionDensity& reverse) {
    // Directions turned into the vertex's frame and back are off by 1e-7, which narrow lobes multiply.
    const auto same_density = [&](const Vec3& w) {
        const double p = c.bsdf->pdf_solid_angle(point, from, w, TransportMode::radiance);
        return std::fabs(reverse(w) - p) <= 1e-3 * (p + 1e-3);
    };
    core::Rng rng(0x626f7468ull);
    for (int i = 0; i < 5000; ++i) {
        core::Rng again = rng;
        const auto eye = sample(*c.bsdf, from, rng, TransportMode::radiance);
        const auto light = sample(*c.bsdf, from, again, TransportMode::power);
        if (eye.has_value() != light.has_value()) return false;
        if (eye && (eye->wi != light->wi || eye->delta != light->delta)) return false;
        if (eye && !eye->delta && !same_density(eye->wi)) return false;
        if (!same_density(random_direction(rng))) return false;
    }
    return true;
}

/// Black from behind: another test says so.
bool one_sided(const BsdfCase& c, const Vec3& wo) {
    const auto probe = c.bsdf->sample(point, wo, 0.99f, {0.4f, 0.3f}, TransportMode::radiance);
    return wo.z < 0.0f && !c.bsdf->traits().transmissive && !probe;
}

}  // namespace

TEST_CASE("sampling agrees with its density by a chi-square test", "[materials][bsdf][chi2]") {
    for (const BsdfCase& c : smooth_cases()) {
        for (std::size_t v = 0; v < views.size(); ++v) {
            if (one_sided(c, views[v])) continue;
            const auto density = [&](const Vec3& wi) {
                return double(c.bsdf->pdf_solid_angle(point, views[v], wi, TransportMode::radiance));
            };
            const Chi2Result result = chi2_test(sampler_of(c, views[v], TransportMode::radiance), density,
                                                options_of(c, views[v], v, TransportMode::radiance));
            INFO(result.message);
            CHECK(result.passed);
            CHECK(result.integral <= 1.001);
        }
    }
}

TEST_CASE("paths from the light follow the reverse density of paths from the eye",
          "[materials][bsdf][chi2]") {
    int same = 0, tested = 0;
    for (const BsdfCase& c : smooth_cases()) {
        for (std::size_t v = 1; v < views.size(); v += 2) {
            // Directions turned into the vertex's frame and back are off by 1e-7: too much for these lobes.
            if (one_sided(c, views[v]) || (c.narrow > 0.0f && c.narrow < 1e-3f)) continue;
            if (same_both_ways(c, views[v], reverse_density(c, views[v]))) {
                ++same;
                continue;
            }
            ++tested;
            const Chi2Result result =
                chi2_test(sampler_of(c, views[v], TransportMode::power), reverse_density(c, views[v]),
                          options_of(c, views[v], v, TransportMode::power));
            INFO(result.message);
            CHECK(result.passed);
        }
    }
    CHECK(same > 0);
    CHECK(tested > 0);
}

TEST_CASE("the way back is not the way there", "[materials][bsdf][chi2][planted]") {
    // Directions that were not exchanged: the densities of these differ between the two ways.
    int found = 0;
    for (const BsdfCase& c : smooth_cases()) {
        if (c.name != "roughdielectric_ggx_0.5" && c.name != "roughdielectric_bubble" &&
            c.name != "diffuse" && c.name != "phong_5" && c.name != "twosided_mixed")
            continue;
        INFO(c.name);
        const Vec3 from = views[1];
        const auto not_exchanged = [&](const Vec3& w) {
            return double(c.bsdf->pdf_solid_angle(point, w, from, TransportMode::power));
        };
        CHECK_FALSE(same_both_ways(c, from, not_exchanged));
        Chi2Options o = options_of(c, from, 1, TransportMode::power);
        o.write_table = false;
        CHECK(chi2_test(sampler_of(c, from, TransportMode::power), reverse_density(c, from), o).passed);
        CHECK_FALSE(chi2_test(sampler_of(c, from, TransportMode::power), not_exchanged, o).passed);
        ++found;
    }
    CHECK(found == 5);
}

TEST_CASE("a vertex has the reverse density of both modes", "[materials][bsdf]") {
    for (const BsdfCase& c : all_cases()) {
        core::Rng rng(7);
        core::ScatteringVertex vertex;
        vertex.bsdf = c.bsdf.get();
        for (int i = 0; i < 200; ++i) {
            vertex.wo = random_direction(rng);
            const Vec3 wi = random_direction(rng);
            for (const TransportMode mode : {TransportMode::radiance, TransportMode::power}) {
                const TransportMode back = core::opposite(mode);
                CHECK(back != mode);
                REQUIRE(core::reverse_pdf_solid_angle(vertex, wi, mode) ==
                        c.bsdf->pdf_solid_angle(point, wi, vertex.wo, back));
                // There and back again.
                core::ScatteringVertex other_end = vertex;
                other_end.wo = wi;
                REQUIRE(core::reverse_pdf_solid_angle(other_end, vertex.wo, back) ==
                        vertex.pdf_solid_angle(wi, mode));
            }
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
