// Roughness as a scene file gives it.
#include "core/materials/microfacet_manual.h"
#include "core/materials/roughness.h"
#include "core/materials/textures.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

constexpr float default_alpha = 0.1f, largest_alpha = 10.0f;

MicrofacetKind kind_parameter(const Properties& p) {
    const bool ggx = p.get_choice("distribution", "beckmann", {"beckmann", "ggx"}) == "ggx";
    return ggx ? MicrofacetKind::ggx : MicrofacetKind::beckmann;
}

void warn_of_smooth(const Properties& p, const std::string& name, float least) {
    if (least < Microfacet::smallest_alpha)
        p.warn("'" + name + "' is raised to 0.0001, the smallest roughness that rough surfaces resolve");
}

std::shared_ptr<const Texture> alpha_texture(const Properties& p, const std::string& name) {
    auto alpha = scalar_texture(p, name, default_alpha, 0.0f, largest_alpha);
    warn_of_smooth(p, name, alpha->minimum());
    return alpha;
}

}  // namespace

Microfacet microfacet_parameters(const Properties& p) {
    const float alpha = float(p.get_float_in("alpha", default_alpha, 0.0, largest_alpha));
    warn_of_smooth(p, "alpha", alpha);
    return {kind_parameter(p), alpha};
}

Roughness roughness_parameters(const Properties& p) {
    const MicrofacetKind kind = kind_parameter(p);
    const bool u = p.has("alpha_u"), v = p.has("alpha_v");
    if (!u && !v) {
        const auto alpha = alpha_texture(p, "alpha");
        return {kind, alpha, alpha};
    }
    if (u != v)
        throw InputError("'alpha_u' and 'alpha_v' must be given together",
                         p.where_of(u ? "alpha_u" : "alpha_v"));
    if (p.has("alpha"))
        throw InputError("give either 'alpha' or 'alpha_u' and 'alpha_v'", p.where_of("alpha"));
    return {kind, alpha_texture(p, "alpha_u"), alpha_texture(p, "alpha_v")};
}

void append_microfacet_parameters(Manual& manual, bool anisotropic) {
    auto& rows = manual.parameters;
    rows.push_back({"distribution", "string", "beckmann", "of the facets' normals: beckmann or ggx"});
    const char* type = anisotropic ? "texture" : "float";
    rows.push_back({"alpha", type, "0.1", "roughness (root mean square slope), 0.0001 to 10"});
    if (anisotropic) {
        rows.push_back({"alpha_u", type, "alpha", "roughness along the tangent, with alpha_v"});
        rows.push_back({"alpha_v", type, "alpha", "roughness along the bitangent, with alpha_u"});
    }
}

}  // namespace mote::core
