// Lights: what is ours about them in Mitsuba's words.
#include <fmt/format.h>

#include "apps/export/export_context.h"
#include "core/formats/xml/scene_values.h"

namespace mote::apps {

using core::Element;

/// Mitsuba's area light has no `scale`.
void export_emitter(Element& emitter, const ExportContext& context) {
    if (emitter.child("filename")) context.copy_file(emitter, "textures");
    const Element* scale = emitter.get("type") == "area" ? emitter.child("scale") : nullptr;
    if (!scale) return;
    const auto factor = float(core::parse_number(scale->get("value"), scale->where));
    remove_child(emitter, "scale");
    const Element* radiance = emitter.child("radiance");
    if (radiance && !core::is_value_tag(radiance->tag)) {
        context.note(emitter, fmt::format("'scale' {} of a textured area light was dropped", factor));
        return;
    }
    const core::Rgb value = radiance ? colour_of(*radiance, true) : core::Rgb(1.0f);
    set_child(emitter, make_rgb(emitter, "radiance", factor * value));
}

}  // namespace mote::apps
