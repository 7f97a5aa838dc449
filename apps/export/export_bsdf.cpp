// BSDFs whose parameters the two programs read differently.
#include <fmt/format.h>

#include <cmath>

#include "apps/export/export_context.h"
#include "core/formats/xml/scene_values.h"
#include "core/materials/index_of_refraction.h"

namespace mote::apps {

using core::Element;

namespace {

void export_index(Element& bsdf, const std::string& name) {
    const Element* value = bsdf.child(name);
    if (!value || value->tag != "string") return;
    if (const auto index = core::dielectric_index(value->get("value")))
        set_child(bsdf, bsdf.make_value("float", name, fmt::format("{}", *index)));
}

/// Phong's lobe of exponent n has about the slopes of Beckmann facets with alpha^2 = 2 / (n + 2) (Walter et
/// al. 2007 use this relation between the two distributions of normals).
void replace_phong(Element& bsdf, const ExportContext& context) {
    const Element* exponent = bsdf.child("exponent");
    const double n = exponent ? core::parse_number(exponent->get("value"), exponent->where) : 30.0;
    const double alpha = std::fmax(std::sqrt(2.0 / (n + 2.0)), 1e-4);
    context.note(bsdf,
                 fmt::format("bsdf 'phong' became 'roughplastic' of alpha {:.4g}: not the same", alpha));
    bsdf.set("type", "roughplastic");
    remove_child(bsdf, "exponent");
    set_child(bsdf, bsdf.make_value("float", "alpha", fmt::format("{}", alpha)));
}

/// A parameter of ours that Mitsuba would refuse.
void drop_conservation(Element& bsdf, const ExportContext& context) {
    const Element* conserves = bsdf.child("conserve_energy");
    if (!conserves) return;
    if (conserves->get("value") == "true")
        context.note(*conserves,
                     "'conserve_energy' is left out: light that facets send to each other is lost there");
    remove_child(bsdf, "conserve_energy");
}

}  // namespace

void export_bsdf(Element& bsdf, const ExportContext& context) {
    const std::string type = bsdf.get("type");
    if (type == "phong") replace_phong(bsdf, context);
    if (type == "roughplastic") drop_conservation(bsdf, context);
    export_index(bsdf, "int_ior");
    export_index(bsdf, "ext_ior");
}

}  // namespace mote::apps
