// Roughness as a scene file gives it.
#include "core/materials/roughness.h"

namespace mote::core {
namespace {

const Choices<MicrofacetKind> distributions{{"beckmann", MicrofacetKind::beckmann},
                                            {"ggx", MicrofacetKind::ggx}};
constexpr const char* distribution_sentence = "Distribution of the facets' normals.";
constexpr const char* alpha_sentence =
    "Roughness (root mean square slope); below 0.0001 it is raised to that.";
constexpr double largest_alpha = 10.0;

void warn_of_smooth(const Properties& p, const std::string& name, float least) {
    if (least < Microfacet::smallest_alpha)
        p.warn("'" + name + "' is raised to 0.0001, the smallest roughness that rough surfaces resolve");
}

}  // namespace

const ParameterList<RoughnessSettings>& roughness_rows() {
    using S = RoughnessSettings;
    static const ParameterList<S> list{
        row("distribution", &S::distribution, distributions, distribution_sentence),
        row("alpha", &S::alpha, between(0, largest_alpha), alpha_sentence),
        row("alpha_u", &S::alpha_u, between(0, largest_alpha), "Roughness along the tangent, with alpha_v.")
            .when_absent("alpha"),
        row("alpha_v", &S::alpha_v, between(0, largest_alpha), "Roughness along the bitangent, with alpha_u.")
            .when_absent("alpha")};
    return list;
}

const ParameterList<MicrofacetSettings>& microfacet_rows() {
    using S = MicrofacetSettings;
    static const ParameterList<S> list{
        row("distribution", &S::distribution, distributions, distribution_sentence),
        row("alpha", &S::alpha, between(0, largest_alpha), alpha_sentence)};
    return list;
}

Microfacet microfacet_of(const MicrofacetSettings& settings, const Properties& p) {
    warn_of_smooth(p, "alpha", settings.alpha);
    return {settings.distribution, settings.alpha};
}

Roughness roughness_of(const RoughnessSettings& s, const Properties& p) {
    if (!s.alpha_u && !s.alpha_v) {
        warn_of_smooth(p, "alpha", s.alpha->minimum());
        return {s.distribution, s.alpha, s.alpha};
    }
    if (!s.alpha_u || !s.alpha_v)
        throw InputError("'alpha_u' and 'alpha_v' must be given together",
                         p.where_of(s.alpha_u ? "alpha_u" : "alpha_v"));
    if (p.has("alpha"))
        throw InputError("give either 'alpha' or 'alpha_u' and 'alpha_v'", p.where_of("alpha"));
    warn_of_smooth(p, "alpha_u", s.alpha_u->minimum());
    warn_of_smooth(p, "alpha_v", s.alpha_v->minimum());
    return {s.distribution, s.alpha_u, s.alpha_v};
}

}  // namespace mote::core
