// Each material of pbrt-v4 (its materials.cpp) as a BSDF of ours, or the nearest one.
#include <algorithm>
#include <cmath>

#include "core/formats/conversion/scene_xml.h"
#include "core/formats/pbrt/pbrt_materials.h"
#include "core/formats/pbrt/pbrt_presets.h"

namespace mote::core {
namespace {

constexpr float min_alpha = 1e-3f;  // below it pbrt takes a surface as smooth

/// Diffuse reflectance of a half space that scatters (Jensen et al. 2001, Eq. 15).
Rgb dipole_reflectance(const Rgb& sigma_s, const Rgb& sigma_a, double eta) {
    const double f = -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta, a = (1.0 + f) / (1.0 - f);
    Rgb out;
    for (int i = 0; i < 3; ++i) {
        const double albedo = sigma_s[i] / std::fmax(double(sigma_s[i]) + sigma_a[i], 1e-20);
        const double root = std::sqrt(3.0 * (1.0 - albedo));
        out[i] = float(0.5 * albedo * (1.0 + std::exp(-4.0 / 3.0 * a * root)) * std::exp(-root));
    }
    return out;
}

/// Colour of hair with absorption sigma_a (Chiang et al. 2016, Eq. 9).
Rgb hair_color(const Rgb& sigma_a, double b) {
    const double d = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))));
    return glm::exp(-glm::sqrt(sigma_a) * float(d));
}

}  // namespace

bool PbrtMaterials::Roughness::smooth() const {
    const auto below = [](const PbrtTexturePtr& t) { return t->constant() && t->value({}).x < min_alpha; };
    return below(u) && below(v);
}

/// alpha = sqrt(roughness), unless remaproughness is off.
PbrtMaterials::Roughness PbrtMaterials::roughness(const PbrtObject& object, const std::string& prefix) {
    const PbrtTexturePtr both = textures_.get(object, prefix + "roughness", 0.0, false);
    const bool remap = object.flag("remaproughness", true);
    const auto alpha = [&](const char* name) {
        PbrtTexturePtr t = textures_.find(object, prefix + name, false);
        if (!t) t = both;
        return remap ? pbrt_function({t}, [](const auto& v) { return glm::sqrt(glm::max(v[0], 0.0f)); }) : t;
    };
    const PbrtTexturePtr u = alpha("uroughness"), v = alpha("vroughness");
    const bool same = !object.find(prefix + "uroughness") && !object.find(prefix + "vroughness");
    return {u, same ? u : v};
}

void PbrtMaterials::add_roughness(pugi::xml_node bsdf, const Roughness& alpha) {
    add_value(bsdf, "string", "distribution", "ggx");
    if (alpha.u == alpha.v) return textures_.add(bsdf, "alpha", alpha.u, true);
    textures_.add(bsdf, "alpha_u", alpha.u, true), textures_.add(bsdf, "alpha_v", alpha.v, true);
}

void PbrtMaterials::diffuse(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    textures_.add(add_object(parent, "bsdf", "diffuse", "", id), "reflectance",
                  textures_.get(object, "reflectance", 0.5, true), false);
}

void PbrtMaterials::add_coating(pugi::xml_node parent, const std::string& id, const PbrtObject& object,
                                const PbrtTexturePtr& base, double eta) {
    const Roughness alpha = roughness(object);
    pugi::xml_node bsdf = add_object(parent, "bsdf", alpha.smooth() ? "plastic" : "roughplastic", "", id);
    textures_.add(bsdf, "diffuse_reflectance", base, false);
    add_float(bsdf, "int_ior", eta), add_float(bsdf, "ext_ior", 1.0);
    add_value(bsdf, "boolean", "nonlinear", "true");
    if (alpha.smooth()) return;
    if (!alpha.u->constant() || alpha.u != alpha.v)
        files_.note("a coating has one roughness here: the mean of what varies");
    add_value(bsdf, "string", "distribution", "ggx");
    add_float(bsdf, "alpha", 0.5 * double(luminance(alpha.u->mean()) + luminance(alpha.v->mean())));
}

void PbrtMaterials::coated_diffuse(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    object.ignore({"thickness", "maxdepth", "nsamples", "g"});
    if (object.find("albedo"))
        files_.fault(object.where, "a coating that holds a medium has no counterpart here", "it is clear");
    add_coating(parent, id, object, textures_.get(object, "reflectance", 0.5, true),
                pbrt_index_of_refraction(object, "eta", 1.5, files_));
}

void PbrtMaterials::add_metal(pugi::xml_node parent, const std::string& id, const PbrtObject& object,
                              const std::string& prefix) {
    const Roughness alpha = roughness(object, prefix);
    pugi::xml_node bsdf = add_object(parent, "bsdf", alpha.smooth() ? "conductor" : "roughconductor", "", id);
    if (!alpha.smooth()) add_roughness(bsdf, alpha);
    const PbrtTexturePtr reflectance = textures_.find(object, "reflectance", true);
    if (reflectance && !reflectance->constant()) {
        files_.note(
            "a metal's reflectance texture multiplies a mirror here, white at grazing angles in pbrt");
        return textures_.add(bsdf, "specular_reflectance", reflectance, false);
    }
    const auto copper = [&](const char* name) {
        PbrtObject o;
        o.parameters.push_back(
            {"spectrum", name, {}, {std::string("metal-Cu-") + name}, object.where, "srgb"});
        return *pbrt_color(o, name, files_, false);
    };
    Rgb eta(1.0f), k;
    if (reflectance) {
        const Rgb r = glm::clamp(reflectance->value({}), 0.0f, 0.9999f);
        k = 2.0f * glm::sqrt(r) / glm::sqrt(Rgb(1.0f) - r);
    } else {
        eta = textures_.get(object, prefix + "eta", 0.0, true)->mean();
        k = textures_.get(object, prefix + "k", 0.0, true)->mean();
        if (!object.find(prefix + "eta")) eta = copper("eta");
        if (!object.find(prefix + "k")) k = copper("k");
    }
    add_rgb(bsdf, "eta", eta), add_rgb(bsdf, "k", k);
}

void PbrtMaterials::conductor(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    add_metal(parent, id, object, "");
}

void PbrtMaterials::coated_conductor(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    object.ignore({"thickness", "maxdepth", "nsamples", "g", "albedo", "interface.roughness",
                   "interface.uroughness", "interface.vroughness", "interface.eta"});
    replaced(object, "the metal without its coating");
    add_metal(parent, id, object, "conductor.");
}

void PbrtMaterials::dielectric(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    const Roughness alpha = roughness(object);
    pugi::xml_node bsdf =
        add_object(parent, "bsdf", alpha.smooth() ? "dielectric" : "roughdielectric", "", id);
    add_float(bsdf, "int_ior", pbrt_index_of_refraction(object, "eta", 1.5, files_)),
        add_float(bsdf, "ext_ior", 1.0);
    if (!alpha.smooth()) add_roughness(bsdf, alpha);
}

void PbrtMaterials::thin_dielectric(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    pugi::xml_node bsdf = add_object(parent, "bsdf", "thindielectric", "", id);
    add_float(bsdf, "int_ior", pbrt_index_of_refraction(object, "eta", 1.5, files_)),
        add_float(bsdf, "ext_ior", 1.0);
}

/// A sheet whose diffuse lobe reflects and transmits: base colour R + T, of which the fraction T / (R + T)
/// passes.
void PbrtMaterials::diffuse_transmission(pugi::xml_node parent, const std::string& id,
                                         const PbrtObject& object) {
    replaced(object, "a thin sheet ('principledthin')");
    const float scale = float(object.number("scale", 1.0));
    const std::vector<PbrtTexturePtr> both = {textures_.get(object, "reflectance", 0.25, true),
                                              textures_.get(object, "transmittance", 0.25, true)};
    pugi::xml_node bsdf = add_object(parent, "bsdf", "principledthin", "", id);
    textures_.add(bsdf, "base_color",
                  pbrt_function(both, [=](const auto& v) { return glm::min(scale * (v[0] + v[1]), 1.0f); }),
                  false);
    textures_.add(
        bsdf, "diff_trans",
        pbrt_function(both,
                      [](const auto& v) {
                          return Rgb(2.0f * luminance(v[1]) / std::fmax(luminance(v[0] + v[1]), 1e-6f));
                      }),
        true);
    add_float(bsdf, "roughness", 0.5), add_float(bsdf, "eta", 1.0);
}

void PbrtMaterials::mix(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    const PbrtParameter* p = object.find("materials");
    if (!p || p->strings.size() != 2)
        throw InputError("a mix needs \"string materials\" with two names", object.where);
    pugi::xml_node bsdf = add_object(parent, "bsdf", "blendbsdf", "", id);
    textures_.add(bsdf, "weight", textures_.get(object, "amount", 0.5, false), true);
    for (const std::string& name : p->strings) {
        const std::string nested = named(name, p->where);
        if (nested == id) throw InputError("a mix holds itself", p->where);
        use(nested);
        add_ref(bsdf, nested);
    }
}

void PbrtMaterials::interface(pugi::xml_node parent, const std::string& id, const PbrtObject&) {
    add_object(parent, "bsdf", "null", "", id);
}

void PbrtMaterials::measured(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    object.ignore({"filename"});
    replaced(object, "a grey diffuse");
    add_rgb(add_object(parent, "bsdf", "diffuse", "", id), "reflectance", Rgb(0.5f));
}

void PbrtMaterials::subsurface(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    object.ignore({"mfp", "g", "scale"});
    replaced(object, "a diffuse base of the same reflectance under a coating");
    const double eta = pbrt_index_of_refraction(object, "eta", 1.33, files_);
    PbrtTexturePtr base = textures_.find(object, "reflectance", true);
    if (!base) {
        Rgb sigma_a(0.0011f, 0.0024f, 0.014f), sigma_s(2.55f, 3.21f, 3.77f);
        if (const std::string name = object.text("name", ""); !name.empty()) {
            const PbrtPreset& preset = pbrt_preset(name, object.find("name")->where);
            sigma_a = preset.sigma_a, sigma_s = preset.sigma_s;
        }
        if (object.find("sigma_a")) sigma_a = textures_.get(object, "sigma_a", 0.0, true)->mean();
        if (object.find("sigma_s")) sigma_s = textures_.get(object, "sigma_s", 0.0, true)->mean();
        base = pbrt_constant(dipole_reflectance(sigma_s, sigma_a, eta));
    }
    add_coating(parent, id, object, base, eta);
}

void PbrtMaterials::hair(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    object.ignore({"eta", "beta_m", "alpha"});
    replaced(object, "a diffuse surface of its colour");
    PbrtTexturePtr color = textures_.find(object, "reflectance", true);
    if (!color) color = textures_.find(object, "color", true);
    const float eu = float(object.number("eumelanin", 0.0)), pheo = float(object.number("pheomelanin", 0.0));
    const bool melanin = eu > 0.0f || pheo > 0.0f;
    // Concentrations to absorption: d'Eon et al. 2011; brown hair where nothing is given.
    Rgb sigma_a = (melanin ? eu : 1.3f) * Rgb(0.419f, 0.697f, 1.37f) + pheo * Rgb(0.187f, 0.4f, 1.05f);
    if (object.find("sigma_a")) sigma_a = textures_.get(object, "sigma_a", 0.0, true)->mean();
    const double beta_n = object.number("beta_n", 0.3);
    if (!color) color = pbrt_constant(hair_color(sigma_a, beta_n));
    textures_.add(add_object(parent, "bsdf", "diffuse", "", id), "reflectance", color, false);
}

}  // namespace mote::core
