// "principled" and "principledthin" as a scene file gives them.
#include <cmath>

#include "core/materials/bsdfs.h"
#include "core/materials/register_materials.h"
#include "core/materials/textures.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

std::shared_ptr<const Texture> weight(const Properties& p, const std::string& name,
                                      float default_value = 0.0f) {
    return scalar_texture(p, name, default_value, 0.0f, 1.0f);
}

/// How often a lobe is drawn, relative to the others.
float rate(const Properties& p, const std::string& name) {
    return float(p.get_float_in(name, 1.0, 0.0, 1e6));
}

/// Index of the facets; `specular` 0 to 1 is a scale of reflectances head on from 0 to 0.08 (Burley 2012,
/// Sec. 5.1).
float index_parameter(const Properties& p, bool transmits) {
    if (p.has("eta")) {
        if (p.has("specular")) throw InputError("give either 'eta' or 'specular'", p.where_of("specular"));
        return float(p.get_float_in("eta", 1.5, 0.01, 100.0));
    }
    double specular = p.get_float_in("specular", 0.5, 0.0, 1.0);
    if (transmits && specular == 0.0) specular = 1e-3;  // as in Mitsuba: glass needs an index
    return float(2.0 / (1.0 - std::sqrt(0.08 * specular)) - 1.0);
}

const std::vector<Parameter> shared_rows = {
    {"base_color", "texture", "0.5", "colour of the base and of metal, 0 to 1; glass has its square root"},
    {"roughness", "texture", "0.5",
     "of all glossy lobes but the clearcoat, 0 to 1: GGX of alpha = roughness^2"},
    {"anisotropic", "texture", "0", "0 to 1: stretches the reflection along the tangent"},
    {"spec_trans", "texture", "0", "0 to 1: share of the surface that is glass"},
    {"spec_tint", "texture", "0", "0 to 1: tints the dielectric's reflection with base_color"},
    {"sheen", "texture", "0", "0 to 1: light at grazing angles as of cloth; adds light"},
    {"sheen_tint", "texture", "0", "0 to 1: tints the sheen with base_color"},
    {"flatness", "texture", "0", "0 to 1: from a diffuse base to one that looks like subsurface scattering"},
    {"diffuse_reflectance_sampling_rate", "float", "1", "how often the diffuse lobe is drawn, relatively"},
};

Manual manual_of(const std::string& type, const std::string& summary, const std::vector<Parameter>& rows,
                 const std::string& example) {
    Manual manual{Category::bsdf, type, summary, shared_rows, example};
    manual.parameters.insert(manual.parameters.end(), rows.begin(), rows.end());
    return manual;
}

std::shared_ptr<Object> create_principled(const Properties& p) {
    PrincipledParameters q;
    q.base_color = reflectance_texture(p, "base_color", Rgb(0.5f));
    q.roughness = weight(p, "roughness", 0.5f);
    q.anisotropic = weight(p, "anisotropic");
    q.metallic = weight(p, "metallic");
    q.spec_trans = weight(p, "spec_trans");
    q.spec_tint = weight(p, "spec_tint");
    q.sheen = weight(p, "sheen");
    q.sheen_tint = weight(p, "sheen_tint");
    q.flatness = weight(p, "flatness");
    q.clearcoat = weight(p, "clearcoat");
    q.clearcoat_gloss = weight(p, "clearcoat_gloss");
    q.eta = index_parameter(p, q.spec_trans->maximum() > 0.0f);
    q.rates.diffuse = rate(p, "diffuse_reflectance_sampling_rate");
    q.rates.specular = rate(p, "main_specular_sampling_rate");
    q.rates.clearcoat = rate(p, "clearcoat_sampling_rate");
    return make_principled(q);
}

std::shared_ptr<Object> create_principled_thin(const Properties& p) {
    PrincipledThinParameters q;
    q.base_color = reflectance_texture(p, "base_color", Rgb(0.5f));
    q.roughness = weight(p, "roughness", 0.5f);
    q.anisotropic = weight(p, "anisotropic");
    q.spec_trans = weight(p, "spec_trans");
    q.eta = scalar_texture(p, "eta", 1.5f, 0.01f, 100.0f);
    q.spec_tint = weight(p, "spec_tint");
    q.sheen = weight(p, "sheen");
    q.sheen_tint = weight(p, "sheen_tint");
    q.flatness = weight(p, "flatness");
    q.diff_trans = scalar_texture(p, "diff_trans", 0.0f, 0.0f, 2.0f);
    q.rates.diffuse = rate(p, "diffuse_reflectance_sampling_rate");
    q.rates.diffuse_through = rate(p, "diffuse_transmittance_sampling_rate");
    q.rates.specular = rate(p, "specular_reflectance_sampling_rate");
    q.rates.specular_through = rate(p, "specular_transmittance_sampling_rate");
    return make_principled_thin(q);
}

}  // namespace

void register_principled(Registry& registry) {
    registry.add(
        manual_of(
            "principled", "Metal, plastic, cloth or glass from one set of weights (Burley's, of Disney).",
            {{"metallic", "texture", "0", "0 to 1: share of the surface that is metal"},
             {"eta", "float", "specular", "index of refraction inside over outside, instead of specular"},
             {"specular", "float", "0.5", "0 to 1: reflectance of the dielectric head on, over 0.08"},
             {"clearcoat", "texture", "0", "0 to 1: strength of a second, clear coating"},
             {"clearcoat_gloss", "texture", "0", "0 to 1: from a satin coating to a glossy one"},
             {"main_specular_sampling_rate", "float", "1",
              "how often the glossy lobes are drawn, relatively"},
             {"clearcoat_sampling_rate", "float", "1", "how often the clearcoat is drawn, relatively"}},
            R"(<bsdf type="principled">
    <rgb name="base_color" value="0.7, 0.3, 0.1"/>
    <float name="metallic" value="0.7"/>
    <float name="roughness" value="0.2"/>
    <float name="clearcoat" value="0.6"/>
</bsdf>)"),
        create_principled);
    registry.add(
        manual_of(
            "principledthin", "A sheet such as paper, a leaf or a frosted pane, from one set of weights.",
            {{"eta", "texture", "1.5", "index of refraction, 0.01 to 100"},
             {"diff_trans", "texture", "0", "0 to 2: share of the diffuse light that passes, times two"},
             {"diffuse_transmittance_sampling_rate", "float", "1",
              "how often diffuse transmission is drawn, relatively"},
             {"specular_reflectance_sampling_rate", "float", "1",
              "how often glossy reflection is drawn, relatively"},
             {"specular_transmittance_sampling_rate", "float", "1",
              "how often glossy transmission is drawn, relatively"}},
            R"(<bsdf type="principledthin">
    <rgb name="base_color" value="0.7, 0.1, 0.1"/>
    <float name="roughness" value="0.15"/>
    <float name="spec_trans" value="0.8"/>
    <float name="diff_trans" value="0.3"/>
    <float name="eta" value="1.33"/>
</bsdf>)"),
        create_principled_thin);
}

}  // namespace mote::core
