// The base of plastics channel by channel: colours are shifted by what is reflected inside, each by its own
// share.
#include "core/materials/fresnel.h"
#include "core/materials/rough_transmittance.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::tests;
using core::Rgb;
using core::TransportMode;
using core::Vec3;

namespace {

const Rgb base(0.95f, 0.5f, 0.1f);
const Vec3 wo = direction_at(0.8, 0.4), wi = direction_at(0.5, 3.9);

Rgb eval(const core::Bsdf& bsdf) { return bsdf.eval({}, wo, wi, TransportMode::radiance); }

core::PlasticParameters plastic(bool nonlinear) {
    return {1.6f, 1.0f, core::make_constant_texture(base), grey(0.0f), nonlinear};
}

/// d / (1 - d F): all orders of reflection between the base and the inside of the coating.
Rgb shifted(const Rgb& d, double inside) {
    Rgb result;
    for (int k = 0; k < 3; ++k) result[k] = float(double(d[k]) / (1.0 - double(d[k]) * inside));
    return result;
}

bool near(const Rgb& a, const Rgb& b) { return glm::length(a - b) < 1e-4f * glm::length(b); }

}  // namespace

TEST_CASE("a smooth plastic's base is d / (1 - d F) in each channel", "[materials][plastic]") {
    const double inside = core::fresnel_diffuse_reflectance(1.0 / 1.6);
    const auto through = [](const Vec3& w) { return 1.0f - core::fresnel_dielectric(w.z, 1.6f).reflectance; };
    const float coating = through(wo) * through(wi) * core::inv_pi / (1.6f * 1.6f);
    CHECK(near(eval(*core::make_plastic(plastic(true))), coating * shifted(base, inside)));
    CHECK(near(eval(*core::make_plastic(plastic(false))), coating * base / float(1.0 - inside)));
    // The mistake that this is for: the shift of the grey mean for all channels.
    const Rgb grey_shift = base * (shifted(Rgb(core::average(base)), inside).x / core::average(base));
    CHECK_FALSE(near(eval(*core::make_plastic(plastic(true))), coating * grey_shift));
}

TEST_CASE("so is a rough plastic's", "[materials][plastic]") {
    for (const auto& facets : {beckmann(0.2f), ggx(0.6f)}) {
        const double inside = double(core::rough_internal_reflectance(facets, 1.6f));
        const core::RoughTransmittance through(facets, 1.6f, core::LostLight::absorbed);
        const float coating = through(wo.z) * through(wi.z) * core::inv_pi / (1.6f * 1.6f);
        CHECK(near(eval(*core::make_rough_plastic(plastic(true), facets)), coating * shifted(base, inside)));
        CHECK(near(eval(*core::make_rough_plastic(plastic(false), facets)),
                   coating * base / float(1.0 - inside)));
    }
}

TEST_CASE("samples of coloured plastics carry the colour of each lobe", "[materials][plastic]") {
    // Smooth: the coating reflects its own colour alone, the base shows base times coating.
    core::PlasticParameters p = plastic(true);
    p.specular_reflectance = colour(0.2f, 0.6f, 1.0f);
    const auto bsdf = core::make_plastic(p);
    const auto mirrored = bsdf->sample({}, wo, 0.0f, {0.3f, 0.4f}, TransportMode::radiance);
    REQUIRE((mirrored && mirrored->delta));
    CHECK(near(mirrored->weight / mirrored->weight.z, {0.2f, 0.6f, 1.0f}));
    const auto scattered = bsdf->sample({}, wo, 0.999f, {0.3f, 0.4f}, TransportMode::radiance);
    REQUIRE((scattered && !scattered->delta));
    const Rgb expected = shifted(base, core::fresnel_diffuse_reflectance(1.0 / 1.6));
    CHECK(near(scattered->weight / scattered->weight.x, expected / expected.x));
}
