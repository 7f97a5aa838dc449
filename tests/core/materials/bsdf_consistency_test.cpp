// eval(), pdf_solid_angle() and sample() of every BSDF agree; reciprocity; sides; extremes.
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::tests;
using core::Rgb;
using core::TransportMode;
using core::Vec2;
using core::Vec3;

namespace {

const core::BsdfPoint point{};
constexpr TransportMode modes[] = {TransportMode::radiance, TransportMode::power};

bool near(const Rgb& a, const Rgb& b, float relative) {
    for (int k = 0; k < 3; ++k)
        if (!(std::fabs(a[k] - b[k]) <= relative * std::fmax(std::fabs(a[k]), std::fabs(b[k])) + 1e-6f))
            return false;
    return true;
}

/// Random, with some grazing, normal and exactly flat directions.
Vec3 awkward_direction(core::Rng& rng) {
    const float kind = rng.next_float(), phi = 6.2831853f * rng.next_float();
    const float sign = rng.next_float() < 0.5f ? -1.0f : 1.0f;
    if (kind < 0.1f) return direction_at(0.0, double(phi));
    if (kind < 0.2f) return {0.0f, 0.0f, sign};
    if (kind < 0.4f)
        return direction_at(double(sign) * std::pow(10.0, -20.0 * double(rng.next_float())), double(phi));
    if (kind < 0.42f) return {std::cos(phi), std::sin(phi), sign * 1e-44f};
    return random_direction(rng);
}

}  // namespace

TEST_CASE("a smooth sample's weight is f cos / pdf", "[materials]") {
    for (const BsdfCase& c : smooth_cases()) {
        core::Rng rng(1);
        // A lobe of width 1e-4 is computed from directions rounded to 6e-8: relative errors near 1e-3.
        const float tolerance = c.narrow > 0.0f && c.narrow < 1e-3f ? 5e-3f : 5e-4f;
        for (int i = 0; i < 4000; ++i) {
            const Vec3 wo = random_direction(rng);
            for (const TransportMode mode : modes) {
                const auto s = sample(*c.bsdf, wo, rng, mode);
                if (!s) continue;
                const float pdf = c.bsdf->pdf_solid_angle(point, wo, s->wi, mode);
                const Rgb expected = c.bsdf->eval(point, wo, s->wi, mode) * (std::fabs(s->wi.z) / pdf);
                const bool sides = s->transmitted == (wo.z * s->wi.z < 0.0f);
                const bool ok = s->delta ? s->pdf_solid_angle == 0.0f
                                         : s->pdf_solid_angle == pdf && near(s->weight, expected, tolerance);
                if (ok && sides) continue;
                CAPTURE(c.name, wo.x, wo.y, wo.z, s->wi.x, s->wi.y, s->wi.z, pdf, s->pdf_solid_angle);
                CAPTURE(s->weight.x, expected.x, s->delta, s->transmitted);
                FAIL("the sample contradicts eval or pdf");
            }
        }
    }
}

TEST_CASE("light and eye see the same BSDF", "[materials]") {
    for (const BsdfCase& c : smooth_cases()) {
        core::Rng rng(2);
        // A half vector of a narrow lobe carries rounding that differs between the two orders.
        // So does 1 - F next to the critical angle, where it is a square root: that of 6e-8 is 2.4e-4.
        const float tolerance = c.narrow > 0.0f && c.narrow < 1e-3f ? 1e-2f : c.index < 1.0f ? 1e-3f : 1e-4f;
        int compared = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3 wo = random_direction(rng);
            Vec3 wi = random_direction(rng);
            // Half of the pairs lie inside the lobe.
            if (const auto s = sample(*c.bsdf, wo, rng, TransportMode::radiance); s && i % 2 == 0) wi = s->wi;
            const Rgb there = c.bsdf->eval(point, wo, wi, TransportMode::radiance);
            const Rgb back = c.bsdf->eval(point, wi, wo, TransportMode::radiance);
            const Rgb power = c.bsdf->eval(point, wi, wo, TransportMode::power);
            // Radiance over squared index is what is reciprocal (Veach 1997, Eq. 5.13).
            const float n_o = wo.z > 0.0f ? 1.0f : c.index, n_i = wi.z > 0.0f ? 1.0f : c.index;
            compared += there.x > 0.0f;
            const bool one_way = c.bent || !c.reciprocal;
            if ((one_way || near(there / (n_o * n_o), back / (n_i * n_i), tolerance)) &&
                near(there, power, tolerance))
                continue;
            CAPTURE(c.name, i, wo.x, wo.y, wo.z, wi.x, wi.y, wi.z, there.x, back.x, power.x);
            FAIL("not reciprocal");
        }
        CHECK(compared > 500);
    }
}

namespace {

bool good(const Rgb& c, float largest) {
    return core::is_finite(c) && core::min_component(c) >= 0.0f && core::max_component(c) <= largest;
}
bool good(float x) { return core::is_finite(x) && x >= 0.0f; }
bool good(const core::BsdfSample& s, float largest_weight) {
    return core::is_finite(s.wi) && std::fabs(glm::length(s.wi) - 1.0f) < 1e-5f &&
           good(s.weight, largest_weight) && good(s.pdf_solid_angle) &&
           s.delta == (s.pdf_solid_angle == 0.0f);
}

}  // namespace

TEST_CASE("everything stays finite and non-negative, wherever one looks", "[materials]") {
    for (const BsdfCase& c : all_cases()) {
        core::Rng rng(3);
        // Weights stay bounded by construction: by the squared index of radiance, by (n + 2) / (n + 1) of
        // phong, and by the choice between two lobes.
        const float bounded =
            c.heavy ? core::infinity : 2.0f * std::fmax(1.3f, core::sqr(std::fmax(c.index, 1.0f / c.index)));
        for (int i = 0; i < 20000; ++i) {
            const Vec3 wo = awkward_direction(rng), wi = awkward_direction(rng);
            const TransportMode mode = modes[i % 2];
            const float largest = c.bent && mode == TransportMode::power ? core::infinity : bounded;
            const float edges[] = {0.0f, core::one_minus_epsilon, rng.next_float()};
            const auto edge = [&] { return edges[rng.next_u32() % 3]; };
            const Rgb f = c.bsdf->eval(point, wo, wi, mode), albedo = c.bsdf->albedo(point, wo);
            const float pdf = c.bsdf->pdf_solid_angle(point, wo, wi, mode), u_lobe = edge(), u_x = edge();
            const auto s = c.bsdf->sample(point, wo, u_lobe, {u_x, edge()}, mode);
            const bool flat = wo.z == 0.0f || wi.z == 0.0f;
            const bool ok = good(f, core::infinity) && good(pdf) && good(albedo, 1.0f + 1e-5f) &&
                            !(flat && (f.x > 0.0f || pdf > 0.0f)) && (!s || good(*s, largest));
            if (ok) continue;
            CAPTURE(c.name, wo.x, wo.y, wo.z, wi.x, wi.y, wi.z, u_lobe, u_x, pdf, f.x, albedo.x);
            const core::BsdfSample sample = s.value_or(core::BsdfSample{});
            CAPTURE(sample.wi.x, sample.wi.y, sample.wi.z, sample.pdf_solid_angle, sample.weight.x);
            FAIL_CHECK("not finite, negative, or too large");
            break;
        }
    }
}

TEST_CASE("opaque one-sided BSDFs are black from behind", "[materials]") {
    for (const BsdfCase& c : all_cases()) {
        if (c.bsdf->traits().transmissive || c.name.find("twosided") != std::string::npos) continue;
        core::Rng rng(4);
        for (int i = 0; i < 200; ++i) {
            Vec3 wo = random_direction(rng);
            const Vec3 wi = random_direction(rng);
            wo.z = -std::fabs(wo.z);
            CAPTURE(c.name);
            CHECK(core::is_black(c.bsdf->eval(point, wo, wi, TransportMode::radiance)));
            CHECK(core::is_black(c.bsdf->eval(point, wi, wo, TransportMode::radiance)));
            CHECK(c.bsdf->pdf_solid_angle(point, wo, wi, TransportMode::radiance) == 0.0f);
            CHECK_FALSE(c.bsdf->sample(point, wo, 0.5f, {0.3f, 0.4f}, TransportMode::radiance));
            CHECK(core::is_black(c.bsdf->albedo(point, wo)));
        }
    }
}

TEST_CASE("traits say what eval and sample do", "[materials]") {
    for (const BsdfCase& c : all_cases()) {
        const core::BsdfTraits traits = c.bsdf->traits();
        core::Rng rng(5);
        bool smooth = false, delta = false, transmitted = false;
        for (int i = 0; i < 2000; ++i) {
            const Vec3 wo = random_direction(rng);
            const auto s = sample(*c.bsdf, wo, rng, TransportMode::power);
            if (!s) continue;
            (s->delta ? delta : smooth) = true;
            transmitted = transmitted || s->transmitted;
        }
        CAPTURE(c.name);
        CHECK(traits.smooth == smooth);
        CHECK(traits.delta == delta);
        CHECK(traits.transmissive == transmitted);
        if (!traits.pane)
            CHECK(traits.diffuse == (c.bsdf->diffuse_reflectance(point, {0.0f, 0.6f, 0.8f}).has_value() &&
                                     c.bsdf->diffuse_reflectance(point, {0.0f, 0.6f, -0.8f}).has_value()));
        CHECK(traits.null == c.name.ends_with("null"));
    }
}

TEST_CASE("twosided mirrors its front to the back", "[materials]") {
    const auto inner = core::make_rough_plastic({}, beckmann(0.3f));
    const auto both = core::make_twosided(inner);
    core::Rng rng(6);
    for (int i = 0; i < 500; ++i) {
        Vec3 wo = random_direction(rng), wi = random_direction(rng);
        const Vec3 wo_back(wo.x, wo.y, -wo.z), wi_back(wi.x, wi.y, -wi.z);
        CHECK(both->eval(point, wo, wi, TransportMode::radiance) ==
              both->eval(point, wo_back, wi_back, TransportMode::radiance));
        CHECK(both->pdf_solid_angle(point, wo, wi, TransportMode::radiance) ==
              both->pdf_solid_angle(point, wo_back, wi_back, TransportMode::radiance));
        if (wo.z > 0.0f)
            CHECK(both->eval(point, wo, wi, TransportMode::radiance) ==
                  inner->eval(point, wo, wi, TransportMode::radiance));
    }
    const auto diffuse =
        core::make_twosided(core::make_diffuse(grey(0.25f)), core::make_diffuse(grey(0.75f)));
    CHECK(diffuse->traits().diffuse);
    CHECK(diffuse->diffuse_reflectance(point, {0, 0, 1})->x == 0.25f);
    CHECK(diffuse->diffuse_reflectance(point, {0, 0, -1})->x == 0.75f);
    CHECK_FALSE(core::make_twosided(core::make_plastic({}))->diffuse_reflectance(point, {0, 0, 1}));
    CHECK_THROWS_AS(core::make_twosided(core::make_dielectric({})), core::InputError);
    CHECK_THROWS_AS(core::make_twosided(core::make_diffuse(), core::make_null()), core::InputError);
}

TEST_CASE("null passes everything straight on", "[materials]") {
    core::Rng rng(7);
    const auto null = core::make_null();
    for (int i = 0; i < 100; ++i) {
        const Vec3 wo = random_direction(rng);
        const auto s = sample(*null, wo, rng, TransportMode::radiance);
        REQUIRE(s);
        CHECK((s->wi == -wo && s->weight == Rgb(1.0f) && s->delta && s->transmitted && s->eta == 1.0f));
    }
}
