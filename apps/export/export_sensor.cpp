// Sensors, films, samplers, and the integrator.
#include "apps/export/export_context.h"

namespace mote::apps {

using core::Element;

namespace {

void export_film(Element& film) {
    // Mitsuba's default is float16.
    if (!film.child("component_format"))
        film.children.push_back(film.make_value("string", "component_format", "float32"));
}

void export_sampler(Element& sampler, const ExportContext& context) {
    if (sampler.get("type") == "independent") return;
    context.note(sampler, "sampler '" + sampler.get("type") + "' became 'independent'");
    sampler.set("type", "independent");
}

bool chromatic_media(const core::Scene& scene) {
    for (const auto& medium : scene.media())
        if (medium->traits().chromatic) return true;
    return false;
}

}  // namespace

void export_sensor(Element& sensor, const ExportContext& context) {
    bool names_medium = false;
    for (Element& c : sensor.children) {
        if (c.tag == "film") export_film(c);
        if (c.tag == "sampler") export_sampler(c, context);
        const Element& object = core::resolve(c, context.ids);
        names_medium = names_medium || object.tag == "medium";
    }
    // Found from the shapes here; Mitsuba has none unless the sensor names it.
    const core::Medium* around = context.scene.camera_medium_state().current();
    if (!around || names_medium) return;
    sensor.children.push_back(make_reference(sensor, "medium", around->id));
}

std::string export_integrator(Element& scene, const ExportContext& context) {
    Element* integrator = scene.child_with_tag("integrator");
    const std::string nearest = context.scene.has_media() ? "volpath" : "path";
    if (!integrator) {
        scene.children.insert(scene.children.begin(), make_object(scene, "integrator", nearest, ""));
        context.note(scene, "the scene names no integrator: '" + nearest + "' was added");
        return nearest;
    }
    const std::string ours = integrator->get("type");
    std::string theirs = ours == "path" || ours == "volpath" ? ours : nearest;
    // volpath follows one channel of a path; volpathmis combines all three and is far less noisy.
    if (theirs == "volpath" && chromatic_media(context.scene)) theirs = "volpathmis";
    if (theirs != ours) context.note(*integrator, "integrator '" + ours + "' became '" + theirs + "'");
    integrator->set("type", theirs);
    std::erase_if(integrator->children, [&](const Element& c) {
        const std::string name = c.get("name");
        if (name == "max_depth" || name == "rr_depth" || name == "hide_emitters") return false;
        context.note(c, "'" + name + "' of integrator '" + ours + "' was dropped");
        return true;
    });
    return theirs;
}

}  // namespace mote::apps
