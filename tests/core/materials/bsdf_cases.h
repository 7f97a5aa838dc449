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
    /// Has a normal of its own: what light and eye see is the same, but there is no reciprocity, and light
    /// may gain power where it arrives flat, as with all shading normals. Sharp borders cross the sphere.
    bool bent = false;
    bool reciprocal = true;   ///< seen from both ends the same, radiance or power
    bool adds_light = false;  ///< returns more than it receives, at grazing angles
    /// Samples at grazing angles have weights without a bound: flatness divides by the cosines' sum, and the
    /// density is Mitsuba's.
    bool heavy = false;
};

/// A BSDF that is evaluated at one point of its surface, wherever the others are evaluated.
class AtPoint final : public core::Bsdf {
  public:
    AtPoint(core::BsdfPtr nested, const core::BsdfPoint& p) : nested_(std::move(nested)), point_(p) {}
    core::BsdfTraits traits() const override { return nested_->traits(); }
    core::Rgb eval(const core::BsdfPoint&, const core::Vec3& wo, const core::Vec3& wi,
                   core::TransportMode mode) const override {
        return nested_->eval(point_, wo, wi, mode);
    }
    float pdf_solid_angle(const core::BsdfPoint&, const core::Vec3& wo, const core::Vec3& wi,
                          core::TransportMode mode) const override {
        return nested_->pdf_solid_angle(point_, wo, wi, mode);
    }
    std::optional<core::BsdfSample> sample(const core::BsdfPoint&, const core::Vec3& wo, float u_lobe,
                                           const core::Vec2& u, core::TransportMode mode) const override {
        return nested_->sample(point_, wo, u_lobe, u, mode);
    }
    core::StraightPassage straight_passage(const core::BsdfPoint&, const core::Vec3& wo) const override {
        return nested_->straight_passage(point_, wo);
    }
    std::optional<core::Rgb> diffuse_reflectance(const core::BsdfPoint&,
                                                 const core::Vec3& wo) const override {
        return nested_->diffuse_reflectance(point_, wo);
    }
    core::Rgb albedo(const core::BsdfPoint&, const core::Vec3& wo) const override {
        return nested_->albedo(point_, wo);
    }

  private:
    core::BsdfPtr nested_;
    core::BsdfPoint point_;
};

inline core::TexturePtr grey(float v) { return core::make_constant_texture(core::Rgb(v)); }

inline core::TexturePtr colour(float r, float g, float b) { return core::make_constant_texture({r, g, b}); }
/// Two by two squares of uv: a over b.
inline std::shared_ptr<core::Texture> board(float a, float b) {
    return core::make_checkerboard_texture(core::make_constant_texture(core::Rgb(a)),
                                           core::make_constant_texture(core::Rgb(b)));
}

inline core::ConductorParameters gold() { return {*core::conductor_index("Au")}; }

/// The colour that represents a normal in a normal map.
inline core::TexturePtr normal_colour(const core::Vec3& n) {
    return core::make_constant_texture(0.5f * glm::normalize(n) + 0.5f);
}
/// A height field of 0.2 by 0.1 m with slopes along both axes, at a point of it.
inline core::BsdfPtr bumped(core::BsdfPtr nested, float scale) {
    const core::Bitmap heights{2, 2, {core::Rgb(0.0f), core::Rgb(0.6f), core::Rgb(0.2f), core::Rgb(1.0f)}};
    core::BsdfPoint p{{0.4f, 0.6f}};
    p.dp_du = {0.2f, 0.0f, 0.0f}, p.dp_dv = {0.03f, 0.1f, 0.0f};
    return std::make_shared<AtPoint>(
        core::make_bump_map(std::move(nested), core::make_bitmap_texture(heights), scale), p);
}

inline core::Microfacet beckmann(float alpha) { return {core::MicrofacetKind::beckmann, alpha}; }
inline core::Microfacet ggx(float alpha) { return {core::MicrofacetKind::ggx, alpha}; }

/// All lobes at once.
inline core::PrincipledParameters principled_mixture() {
    core::PrincipledParameters p;
    p.base_color = colour(0.7f, 0.4f, 0.1f), p.roughness = grey(0.5f), p.anisotropic = grey(0.6f);
    p.metallic = grey(0.3f), p.spec_trans = grey(0.5f), p.spec_tint = grey(0.4f), p.sheen = grey(0.3f);
    p.sheen_tint = grey(0.5f), p.flatness = grey(0.4f), p.clearcoat = grey(0.8f),
    p.clearcoat_gloss = grey(0.1f);
    return p;
}
inline core::PrincipledThinParameters thin_mixture() {
    core::PrincipledThinParameters p;
    p.base_color = colour(0.7f, 0.4f, 0.1f), p.roughness = grey(0.8f), p.anisotropic = grey(0.6f);
    p.spec_trans = grey(0.4f), p.spec_tint = grey(0.4f), p.sheen = grey(0.3f), p.sheen_tint = grey(0.5f);
    p.flatness = grey(0.4f), p.diff_trans = grey(0.8f), p.eta = grey(1.5f);
    p.rates = {0.4f, 2.0f, 3.0f, 0.7f};
    return p;
}

inline std::vector<BsdfCase> principled_cases() {
    using namespace core;
    const TexturePtr rust = colour(0.7f, 0.4f, 0.1f);
    const auto principled = [&](auto change) {
        PrincipledParameters p;
        p.base_color = rust;
        change(p);
        return make_principled(p);
    };
    const auto thin = [&](auto change) {
        PrincipledThinParameters p;
        p.base_color = rust;
        change(p);
        return make_principled_thin(p);
    };
    PrincipledParameters bubble = principled_mixture(), boards = principled_mixture();
    bubble.eta = 0.8f, bubble.metallic = bubble.anisotropic = grey(0.0f), bubble.roughness = grey(0.4f);
    boards.roughness = board(0.6f, 0.4f), boards.spec_trans = board(0.7f, 0.3f),
    boards.metallic = board(0.1f, 0.4f);
    boards.rates = {0.4f, 2.0f, 3.0f};
    const auto cloth = [](auto& p) {
        p.sheen = p.flatness = p.roughness = grey(1.0f), p.sheen_tint = grey(0.6f);
    };
    std::vector<BsdfCase> all = {
        {"principled_cloth", principled(cloth)},
        {"principled_metal_stretched", principled([](auto& p) {
             p.metallic = grey(1.0f), p.roughness = grey(0.5f), p.anisotropic = grey(1.0f);
         })},
        {"principled_metal_mirror",
         principled([](auto& p) { p.metallic = grey(1.0f), p.roughness = grey(0.0f); }), 1.0f, 1e-3f},
        {"principled_glass_rough_1", principled([](auto& p) { p.spec_trans = p.roughness = grey(1.0f); }),
         1.5f},
        {"principled_coated",
         principled([](auto& p) { p.clearcoat = grey(1.0f), p.clearcoat_gloss = grey(0.2f); })},
        {"principled_mixture", make_principled(principled_mixture()), 1.5f},
        {"principled_bubble", make_principled(bubble), 0.8f},
        {"principled_textured", make_principled(boards), 1.5f},
        {"principledthin_paper", thin([](auto& p) { p.diff_trans = grey(1.0f), p.sheen = grey(0.5f); })},
        {"principledthin_rough_1", thin([](auto& p) { p.spec_trans = p.roughness = grey(1.0f); })},
        {"principledthin_mixture", make_principled_thin(thin_mixture())},
    };
    for (BsdfCase& c : all) {
        const auto is = [&](const std::string& word) { return c.name.ends_with(word); };
        c.reciprocal = !c.name.starts_with("principledthin") || is("paper");
        c.adds_light = is("cloth") || is("bubble");
        c.heavy = is("cloth") || is("mixture") || is("bubble") || is("textured");
    }
    return all;
}

/// BSDFs whose whole scattering is smooth, and those with a smooth part.
inline std::vector<BsdfCase> smooth_cases() {
    using namespace core;
    const Microfacet stretched_b(MicrofacetKind::beckmann, 0.1f, 0.5f);
    const Microfacet stretched_g(MicrofacetKind::ggx, 0.6f, 0.15f);
    const DielectricParameters glass{1.5f, 1.0f};
    const DielectricParameters tinted{1.5f, 1.0f, colour(0.8f, 0.5f, 0.3f), colour(0.2f, 0.6f, 0.9f)};
    const DielectricParameters bubble{1.0f, 1.333f};
    const PlasticParameters plastic{1.49f, 1.000277f, colour(0.6f, 0.9f, 0.1f), grey(1.0f), false};
    const PlasticParameters nonlinear{1.9f, 1.0f, colour(0.9f, 0.5f, 0.1f), colour(0.3f, 0.7f, 1.0f), true};
    const PlasticParameters conserving{1.49f, 1.0f, colour(0.2f, 0.6f, 0.9f), grey(1.0f), true, true};
    const Roughness boards(MicrofacetKind::ggx, board(0.2f, 0.6f), board(0.5f, 0.3f));
    std::vector<BsdfCase> all = {
        {"diffuse", make_diffuse(colour(0.7f, 0.4f, 0.1f))},
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
        {"roughplastic_conserving", make_rough_plastic(conserving, ggx(0.4f))},
        {"roughconductor_textured_stretched", make_rough_conductor(gold(), boards)},
        {"roughdielectric_textured", make_rough_dielectric(tinted, boards), 1.5f},
        {"phong_5", make_phong({5.0f, colour(0.3f, 0.2f, 0.1f), colour(0.1f, 0.4f, 0.6f)})},
        {"phong_80", make_phong({80.0f, colour(0.5f, 0.3f, 0.2f), colour(0.1f, 0.2f, 0.5f)})},
        {"phong_0", make_phong({0.0f, colour(0.2f, 0.1f, 0.0f), colour(0.2f, 0.5f, 0.8f)})},
        {"twosided_diffuse", make_twosided(make_diffuse(colour(0.1f, 0.7f, 0.4f)))},
        {"twosided_mixed",
         make_twosided(make_diffuse(colour(0.3f, 0.2f, 0.6f)), make_rough_conductor(gold(), beckmann(0.4f)))},
        {"mask_leaf", make_mask(make_twosided(make_diffuse(grey(0.7f))), grey(0.3f))},
        {"mask_plastic", make_mask(make_twosided(make_plastic(plastic)), grey(0.8f))},
        {"mask_glass", make_mask(make_rough_dielectric(glass, ggx(0.5f)), grey(0.6f)), 1.5f},
        {"blendbsdf_diffuse_metal",
         make_blend(make_diffuse(grey(0.9f)), make_rough_conductor(gold(), ggx(0.3f)), grey(0.35f))},
        {"blendbsdf_holes",
         make_blend(make_mask(make_twosided(make_diffuse(grey(0.8f))), grey(0.4f)),
                    make_twosided(make_rough_plastic(plastic, beckmann(0.3f))), grey(0.5f))},
        {"normalmap_diffuse", make_normal_map(make_diffuse(grey(0.7f)), normal_colour({0.4f, -0.3f, 0.8f})),
         1.0f, 0.0f, true},
        {"normalmap_steep_metal",
         make_normal_map(make_rough_conductor(gold(), ggx(0.4f)), normal_colour({0.8f, 0.5f, 0.4f})), 1.0f,
         0.0f, true},
        {"normalmap_bare",
         make_normal_map(make_diffuse(grey(0.7f)), normal_colour({-0.6f, 0.1f, 0.8f}),
                         {.flip_invalid_normals = false, .use_shadowing_function = false}),
         1.0f, 0.0f, true},
        {"normalmap_glass",
         make_normal_map(make_rough_dielectric(glass, ggx(0.5f)), normal_colour({0.3f, 0.3f, 0.9f})), 1.5f,
         0.0f, true},
        {"normalmap_mask",
         make_normal_map(make_mask(make_twosided(make_plastic(plastic)), grey(0.7f)),
                         normal_colour({0.3f, -0.2f, 0.9f})),
         1.0f, 0.0f, true},
        {"bumpmap_twosided", bumped(make_twosided(make_diffuse(grey(0.6f))), 0.1f), 1.0f, 0.0f, true},
        {"bumpmap_stretched", bumped(make_rough_conductor(gold(), stretched_g), 0.05f), 1.0f, 0.0f, true},
    };
    for (BsdfCase& c : principled_cases()) all.push_back(std::move(c));
    return all;
}

/// BSDFs that scatter in single directions only.
inline std::vector<BsdfCase> delta_cases() {
    using namespace core;
    return {
        {"conductor_mirror", make_conductor({})},
        {"conductor_gold", make_conductor(gold())},
        {"conductor_tinted", make_conductor({*conductor_index("Cu"), colour(0.3f, 0.6f, 0.9f)})},
        {"dielectric_tinted",
         make_dielectric({1.5f, 1.0f, colour(0.8f, 0.5f, 0.3f), colour(0.2f, 0.6f, 0.9f)}), 1.5f},
        {"thindielectric_tinted",
         make_thin_dielectric({1.5f, 1.0f, colour(0.8f, 0.5f, 0.3f), colour(0.2f, 0.6f, 0.9f)})},
        {"dielectric", make_dielectric({})},
        {"dielectric_water", make_dielectric({1.333f, 1.0f}), 1.333f},
        {"dielectric_equal", make_dielectric({1.4f, 1.4f})},
        {"thindielectric", make_thin_dielectric({})},
        {"null", make_null()},
        {"mask_null", make_mask(make_null(), grey(0.5f))},
        {"mask_pane", make_mask(make_thin_dielectric({}), grey(0.5f))},
        {"blendbsdf_mirrors", make_blend(make_conductor({}), make_thin_dielectric({}), grey(0.75f))},
        {"normalmap_mirror", make_normal_map(make_conductor({}), normal_colour({0.3f, 0.1f, 0.9f})), 1.0f,
         0.0f, true},
        {"normalmap_pane", make_normal_map(make_thin_dielectric({}), normal_colour({0.3f, 0.1f, 0.9f})), 1.0f,
         0.0f, true},
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

/// One sample; the numbers are sampled in the same order by every compiler.
inline std::optional<core::BsdfSample> sample(const core::Bsdf& bsdf, const core::Vec3& wo, core::Rng& rng,
                                              core::TransportMode mode = core::TransportMode::radiance) {
    const float u_lobe = rng.next_float();
    const core::Vec2 u = rng.next_vec2();
    return bsdf.sample({}, wo, u_lobe, u, mode);
}

}  // namespace mote::tests
