// The BSDFs that every general property is tested on, and the directions they are tested from.
#pragma once

#include <string>
#include <vector>

#include "core/materials/bsdfs.h"
#include "core/materials/textures.h"
#include "core/math/random.h"
#include "core/objects/error.h"

namespace mote::tests {

struct BsdfCase {
    std::string name;
    core::BsdfPtr bsdf;
    float index = 1.0f;   ///< inside over outside, for those that transmit light
    float narrow = 0.0f;  ///< width of the lobe where it is too narrow for cells over the sphere, else 0
};

inline core::TexturePtr grey(float v) { return core::make_constant_texture(core::Rgb(v)); }

inline core::ConductorParameters gold() { return {*core::conductor_index("Au"), nullptr}; }

inline core::Microfacet beckmann(float alpha) { return {core::MicrofacetKind::beckmann, alpha}; }
inline core::Microfacet ggx(float alpha) { return {core::MicrofacetKind::ggx, alpha}; }

/// BSDFs whose whole scattering is smooth, and those with a smooth part.
inline std::vector<BsdfCase> smooth_cases() {
    using namespace core;
    const Microfacet stretched_b(MicrofacetKind::beckmann, 0.1f, 0.5f);
    const Microfacet stretched_g(MicrofacetKind::ggx, 0.6f, 0.15f);
    const DielectricParameters glass{1.5f, 1.0f, nullptr, nullptr};
    const DielectricParameters tinted{1.5f, 1.0f, grey(0.8f), grey(0.6f)};
    const DielectricParameters bubble{1.0f, 1.333f, nullptr, nullptr};
    const PlasticParameters plastic{1.49f, 1.000277f, grey(0.6f), nullptr, false};
    const PlasticParameters nonlinear{1.9f, 1.0f, grey(0.9f), grey(0.7f), true};
    return {
        {"diffuse", make_diffuse(grey(0.7f))},
        {"roughconductor_beckmann_0.3", make_rough_conductor(gold(), beckmann(0.3f))},
        {"roughconductor_beckmann_1", make_rough_conductor(gold(), beckmann(1.0f))},
        {"roughconductor_beckmann_stretched", make_rough_conductor(gold(), stretched_b)},
        {"roughconductor_ggx_0.2", make_rough_conductor(gold(), ggx(0.2f))},
        {"roughconductor_ggx_1", make_rough_conductor(gold(), ggx(1.0f))},
        {"roughconductor_ggx_stretched", make_rough_conductor(gold(), stretched_g)},
        {"roughconductor_beckmann_1e-2", make_rough_conductor(gold(), beckmann(1e-2f)), 1.0f, 1e-2f},
        {"roughconductor_ggx_1e-2", make_rough_conductor(gold(), ggx(1e-2f)), 1.0f, 1e-2f},
        {"roughconductor_beckmann_1e-4", make_rough_conductor(gold(), beckmann(1e-4f)), 1.0f, 1e-4f},
        {"roughconductor_ggx_1e-4", make_rough_conductor(gold(), ggx(1e-4f)), 1.0f, 1e-4f},
        {"roughdielectric_beckmann_0.3", make_rough_dielectric(glass, beckmann(0.3f)), 1.5f},
        {"roughdielectric_ggx_0.5", make_rough_dielectric(tinted, ggx(0.5f)), 1.5f},
        {"roughdielectric_ggx_stretched", make_rough_dielectric(glass, stretched_g), 1.5f},
        {"roughdielectric_bubble", make_rough_dielectric(bubble, beckmann(0.4f)), 1.0f / 1.333f},
        {"plastic", make_plastic(plastic)},
        {"plastic_nonlinear", make_plastic(nonlinear)},
        {"roughplastic_beckmann_0.2", make_rough_plastic(plastic, beckmann(0.2f))},
        {"roughplastic_ggx_0.5", make_rough_plastic(nonlinear, ggx(0.5f))},
        {"phong_5", make_phong({5.0f, grey(0.3f), grey(0.6f)})},
        {"phong_80", make_phong({80.0f, grey(0.5f), grey(0.5f)})},
        {"phong_0", make_phong({0.0f, grey(0.2f), grey(0.8f)})},
        {"twosided_diffuse", make_twosided(make_diffuse(grey(0.7f)))},
        {"twosided_mixed",
         make_twosided(make_diffuse(grey(0.3f)), make_rough_conductor(gold(), beckmann(0.4f)))},
    };
}

/// BSDFs that scatter in single directions only.
inline std::vector<BsdfCase> delta_cases() {
    using namespace core;
    return {
        {"conductor_mirror", make_conductor({})},
        {"conductor_gold", make_conductor(gold())},
        {"dielectric", make_dielectric({})},
        {"dielectric_water", make_dielectric({1.333f, 1.0f, nullptr, nullptr}), 1.333f},
        {"dielectric_equal", make_dielectric({1.4f, 1.4f, nullptr, nullptr})},
        {"thindielectric", make_thin_dielectric({})},
        {"null", make_null()},
    };
}

inline std::vector<BsdfCase> all_cases() {
    std::vector<BsdfCase> all = smooth_cases();
    for (BsdfCase& c : delta_cases()) all.push_back(std::move(c));
    return all;
}

/// A unit direction with the given cosine and azimuth.
inline core::Vec3 direction_at(double cosine, double phi) {
    const double r = std::sqrt(std::fmax(0.0, 1.0 - cosine * cosine));
    return {float(r * std::cos(phi)), float(r * std::sin(phi)), float(cosine)};
}

inline core::Vec3 random_direction(core::Rng& rng) {
    const double z = 2.0 * double(rng.next_float()) - 1.0;
    return direction_at(z, 6.283185307179586 * double(rng.next_float()));
}

/// One sample; the numbers are drawn in the same order by every compiler.
inline std::optional<core::BsdfSample> draw(const core::Bsdf& bsdf, const core::Vec3& wo, core::Rng& rng,
                                            core::TransportMode mode = core::TransportMode::radiance) {
    const float u_lobe = rng.next_float();
    const core::Vec2 u = rng.next_vec2();
    return bsdf.sample({}, wo, u_lobe, u, mode);
}

}  // namespace mote::tests
