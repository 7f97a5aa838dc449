// "principled" and "principledthin" as a scene file gives them.
#include <cmath>

#include "core/materials/bsdfs.h"
#include "core/materials/register_materials.h"

namespace mote::core {
namespace {

/// Values of the rates at which lobes are sampled, relative to each other, and of weights.
const Range rate_range = between(0, 1e6), weight_range = between(0, 1);

const ParameterList<PrincipledWeights>& weight_rows() {
    using S = PrincipledWeights;
    static const ParameterList<S> list{
        row("base_color", &S::base_color, weight_range,
            "Colour of the base and of metal; glass has its square root."),
        row("roughness", &S::roughness, weight_range,
            "Roughness of all glossy lobes but the clearcoat: GGX of alpha = roughness^2."),
        row("anisotropic", &S::anisotropic, weight_range, "Stretches the reflection along the tangent."),
        row("spec_trans", &S::spec_trans, weight_range, "Fraction of the surface that is glass."),
        row("spec_tint", &S::spec_tint, weight_range, "Tints the dielectric's reflection with base_color."),
        row("sheen", &S::sheen, weight_range, "Light at grazing angles as of cloth; adds light."),
        row("sheen_tint", &S::sheen_tint, weight_range, "Tints the sheen with base_color."),
        row("flatness", &S::flatness, weight_range,
            "From a diffuse base to one that looks like subsurface scattering.")};
    return list;
}

struct PrincipledSettings : PrincipledParameters {
    std::optional<float> given_eta;
    double specular = 0.5;  ///< a scale of reflectances head on from 0 to 0.08 (Burley 2012, Sec. 5.1)

    /// Index of the facets.
    float index(const Properties& p) const {
        if (given_eta) {
            if (p.has("specular"))
                throw InputError("give either 'eta' or 'specular'", p.where_of("specular"));
            return *given_eta;
        }
        // As in Mitsuba: glass needs an index.
        const bool glass_without = specular == 0.0 && spec_trans->maximum() > 0.0f;
        return float(2.0 / (1.0 - std::sqrt(0.08 * (glass_without ? 1e-3 : specular))) - 1.0);
    }
};

const ParameterList<PrincipledSettings>& principled_rows() {
    using S = PrincipledSettings;
    using Rates = PrincipledParameters::Rates;
    static const ParameterList<S> list{
        weight_rows(),
        within(&S::rates, row("diffuse_reflectance_sampling_rate", &Rates::diffuse, rate_range,
                              "How often the diffuse lobe is sampled, relatively.")),
        row("metallic", &S::metallic, weight_range, "Fraction of the surface that is metal."),
        row("eta", &S::given_eta, between(0.01, 100),
            "Index of refraction inside over outside, instead of specular.")
            .when_absent("specular"),
        row("specular", &S::specular, weight_range, "Reflectance of the dielectric head on, over 0.08."),
        row("clearcoat", &S::clearcoat, weight_range, "Strength of a second, clear coating."),
        row("clearcoat_gloss", &S::clearcoat_gloss, weight_range, "From a satin coating to a glossy one."),
        within(&S::rates,
               row("main_specular_sampling_rate", &Rates::specular, rate_range,
                   "How often the glossy lobes are sampled, relatively."),
               row("clearcoat_sampling_rate", &Rates::clearcoat, rate_range,
                   "How often the clearcoat is sampled, relatively."))};
    return list;
}

const ParameterList<PrincipledThinParameters>& principled_thin_rows() {
    using S = PrincipledThinParameters;
    static const ParameterList<S> list{
        weight_rows(), row("eta", &S::eta, between(0.01, 100), "Index of refraction."),
        row("diff_trans", &S::diff_trans, between(0, 2),
            "Fraction of the diffuse light that passes, times two."),
        within(&S::rates,
               row("diffuse_reflectance_sampling_rate", &S::Rates::diffuse, rate_range,
                   "How often the diffuse lobe is sampled, relatively."),
               row("diffuse_transmittance_sampling_rate", &S::Rates::diffuse_through, rate_range,
                   "How often diffuse transmission is sampled, relatively."),
               row("specular_reflectance_sampling_rate", &S::Rates::specular, rate_range,
                   "How often glossy reflection is sampled, relatively."),
               row("specular_transmittance_sampling_rate", &S::Rates::specular_through, rate_range,
                   "How often glossy transmission is sampled, relatively."))};
    return list;
}

}  // namespace

void register_principled(Registry& registry) {
    add_type(registry, Category::bsdf, "principled",
             "Metal, plastic, cloth or glass from one set of weights (Burley's, of Disney).",
             principled_rows(),
             R"(<bsdf type="principled">
    <rgb name="base_color" value="0.7, 0.3, 0.1"/>
    <float name="metallic" value="0.7"/>
    <float name="roughness" value="0.2"/>
    <float name="clearcoat" value="0.6"/>
</bsdf>)",
             [](PrincipledSettings s, const Properties& p) {
                 s.eta = s.index(p);
                 return make_principled(s);
             });
    add_type(registry, Category::bsdf, "principledthin",
             "A sheet such as paper, a leaf or a frosted pane, from one set of weights.",
             principled_thin_rows(), R"(<bsdf type="principledthin">
    <rgb name="base_color" value="0.7, 0.1, 0.1"/>
    <float name="roughness" value="0.15"/>
    <float name="spec_trans" value="0.8"/>
    <float name="diff_trans" value="0.3"/>
    <float name="eta" value="1.33"/>
</bsdf>)",
             make_principled_thin);
}

}  // namespace mote::core
