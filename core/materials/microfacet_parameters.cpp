// Roughness as a scene file gives it.
#include "core/materials/microfacet.h"
#include "core/materials/microfacet_manual.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

constexpr double default_alpha = 0.1, largest_alpha = 10.0;

float alpha_parameter(const Properties& p, const std::string& name) {
    const double alpha = p.get_float_in(name, default_alpha, 0.0, largest_alpha);
    if (alpha < double(Microfacet::smallest_alpha))
        p.warn("'" + name + "' is raised to 0.0001, the smallest roughness that rough surfaces resolve");
    return float(alpha);
}

}  // namespace

Microfacet microfacet_parameters(const Properties& p, bool allow_anisotropic) {
    const bool ggx = p.get_choice("distribution", "beckmann", {"beckmann", "ggx"}) == "ggx";
    const MicrofacetKind kind = ggx ? MicrofacetKind::ggx : MicrofacetKind::beckmann;
    const bool u = allow_anisotropic && p.has("alpha_u"), v = allow_anisotropic && p.has("alpha_v");
    if (!u && !v) return Microfacet(kind, alpha_parameter(p, "alpha"));
    if (u != v)
        throw InputError("'alpha_u' and 'alpha_v' must be given together",
                         p.where_of(u ? "alpha_u" : "alpha_v"));
    if (p.has("alpha"))
        throw InputError("give either 'alpha' or 'alpha_u' and 'alpha_v'", p.where_of("alpha"));
    return Microfacet(kind, alpha_parameter(p, "alpha_u"), alpha_parameter(p, "alpha_v"));
}

void append_microfacet_parameters(Manual& manual, bool anisotropic) {
    auto& rows = manual.parameters;
    rows.push_back({"distribution", "string", "beckmann", "of the facets' normals: beckmann or ggx"});
    rows.push_back({"alpha", "float", "0.1", "roughness (root mean square slope), 0.0001 to 10"});
    if (anisotropic) {
        rows.push_back({"alpha_u", "float", "alpha", "roughness along the tangent, with alpha_v"});
        rows.push_back({"alpha_v", "float", "alpha", "roughness along the bitangent, with alpha_u"});
    }
}

}  // namespace mote::core
