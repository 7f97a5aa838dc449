// Where smooth dielectrics and conductors send light, and how much.
#include "core/materials/fresnel.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::tests;
using core::TransportMode;
using core::Vec3;

namespace {
const core::BsdfPoint point{};
}

TEST_CASE("a dielectric obeys Snell and scales radiance by the squared index", "[materials]") {
    const auto glass = core::make_dielectric({1.5f, 1.0f});
    for (const double cosine : {1.0, 0.8, 0.4, 0.05, -1.0, -0.9, -0.8}) {
        const Vec3 wo = direction_at(cosine, 1.3);
        const float eta = wo.z > 0.0f ? 1.5f : 1.0f / 1.5f;  // wi's side over wo's
        const float f = core::fresnel_dielectric(std::fabs(wo.z), eta).reflectance;
        CAPTURE(cosine, f);
        const auto mirrored = glass->sample(point, wo, 0.999f * f, {}, TransportMode::radiance);
        REQUIRE(mirrored);
        CHECK(mirrored->wi == core::reflect_local(wo));
        CHECK((mirrored->delta && !mirrored->transmitted && mirrored->eta == 1.0f));
        CHECK(mirrored->weight == core::Rgb(1.0f));
        const auto through = glass->sample(point, wo, 0.9999f, {}, TransportMode::radiance);
        REQUIRE((through && through->transmitted && through->delta));
        CHECK(through->eta == Approx(eta));
        CHECK(core::sin_theta(through->wi) * eta == Approx(core::sin_theta(wo)).margin(1e-6));
        CHECK(through->weight.x == Approx(1.0f / (eta * eta)));  // (n_o / n_i)^2
        const auto power = glass->sample(point, wo, 0.9999f, {}, TransportMode::power);
        CHECK(power->weight == core::Rgb(1.0f));
        // The way back leads to where it came from.
        const auto back = glass->sample(point, through->wi, 0.9999f, {}, TransportMode::radiance);
        REQUIRE(back);
        CHECK(glm::length(back->wi - wo) < 1e-4f);
        CHECK(back->weight.x * through->weight.x == Approx(1.0f));
    }
    // Beyond the critical angle everything is reflected.
    for (const float u : {0.0f, 0.5f, core::one_minus_epsilon}) {
        const auto s = glass->sample(point, direction_at(-0.5, 0.0), u, {}, TransportMode::radiance);
        CHECK((s && !s->transmitted));
    }
}

TEST_CASE("a pane reflects all orders between its faces", "[materials]") {
    const auto pane = core::make_thin_dielectric({1.5f, 1.0f});
    const Vec3 wo = direction_at(1.0, 0.0);
    // R = 0.04 a face; 2 R / (1 + R) = 1/13.
    CHECK_FALSE(pane->sample(point, wo, 1.0f / 13.0f - 1e-4f, {}, TransportMode::radiance)->transmitted);
    const auto s = pane->sample(point, wo, 1.0f / 13.0f + 1e-4f, {}, TransportMode::radiance);
    CHECK((s->transmitted && s->wi == -wo && s->weight == core::Rgb(1.0f) && s->eta == 1.0f));
}

TEST_CASE("factors on reflection and transmission", "[materials]") {
    const auto red = core::make_constant_texture({0.5f, 0.0f, 0.0f});
    const auto tinted = core::make_dielectric({1.5f, 1.0f, grey(0.0f), red});
    const Vec3 wo = direction_at(0.9, 0.0);
    CHECK_FALSE(tinted->sample(point, wo, 0.0f, {}, TransportMode::power));
    CHECK(tinted->sample(point, wo, 0.9f, {}, TransportMode::power)->weight == core::Rgb(0.5f, 0.0f, 0.0f));
    const auto metal = core::make_conductor({*core::conductor_index("Cu"), red});
    const core::Rgb f =
        core::fresnel_conductor(wo.z, core::conductor_index("Cu")->eta, core::conductor_index("Cu")->k);
    CHECK(metal->sample(point, wo, 0.0f, {}, TransportMode::power)->weight.x == Approx(0.5f * f.x));
}

TEST_CASE("equal indices make a dielectric invisible", "[materials]") {
    const auto same = core::make_dielectric({1.4f, 1.4f});
    for (const double cosine : {1.0, 0.3, 1e-3}) {
        const Vec3 wo = direction_at(cosine, 0.2);
        const auto s = same->sample(point, wo, 0.0f, {}, TransportMode::radiance);
        CHECK((s && s->transmitted && glm::length(s->wi + wo) < 1e-6f && s->weight == core::Rgb(1.0f)));
    }
    CHECK_THROWS_AS(core::make_rough_dielectric({1.4f, 1.4f}, beckmann(0.1f)), core::InputError);
}
