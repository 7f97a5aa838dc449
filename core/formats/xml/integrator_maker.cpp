// The integrator becomes an element of a scene of its own, which is checked and made like any other.
#include "core/formats/xml/integrator_maker.h"

#include <algorithm>

#include "core/formats/xml/object_maker.h"
#include "core/formats/xml/scene_defines.h"
#include "core/render/integrator.h"
#include "core/scene/scene.h"

namespace mote::core {

namespace {

/// Parameters that the scene file sets for integrators of this type, else for its own, as far as this type
/// has them.
std::vector<Element> inherited_values(const Scene& scene, const std::string& type, const Manual& manual) {
    std::vector<Element> values;
    const Scene::Parts& parts = scene.parts();
    if (!parts.integrator_element) return values;
    const Element* element = parts.integrator_element.get();
    for (const auto& further : parts.further_integrators)
        if (further->get("type") == type && element->get("type") != type) element = further.get();
    for (const Element& child : element->children)
        if (has_place_for(manual, child)) values.push_back(child);
    return values;
}

/// "compensation" or "compensation.depth": a nested object, or a value of one.
bool is_path_of_object(const std::string& name, const Manual& manual) {
    if (name.find('.') != std::string::npos) return true;
    return std::any_of(manual.parameters.begin(), manual.parameters.end(), [&](const Parameter& p) {
        return p.name == name &&
               (p.type == "compensation" || p.type == "visibility" || p.type == "selection");
    });
}

}  // namespace

std::shared_ptr<Integrator> make_integrator(const Registry& registry, const Scene& scene,
                                            const std::string& type,
                                            const std::vector<IntegratorSetting>& settings,
                                            const SourceLocation& where, std::vector<std::string>& warnings) {
    Element element;
    element.tag = "integrator", element.where = where;
    element.set("type", type);
    const Manual& manual = require_manual(element, registry);
    element.children = inherited_values(scene, type, manual);
    for (const IntegratorSetting& setting : settings) {
        if (is_path_of_object(setting.name, manual)) {
            set_by_path(element, setting.name, setting.text, registry, setting.where);
            continue;
        }
        std::erase_if(element.children, [&](const Element& c) { return c.get("name") == setting.name; });
        element.children.push_back(element.make_value(setting.tag, setting.name, setting.text));
        element.children.back().where = setting.where;
    }
    Element root;
    root.tag = "scene", root.where = where;
    root.children.push_back(element);
    Faults faults;
    check_elements(root, registry, warnings, faults);
    const IdTable ids = collect_ids(root, faults);
    check_references(root, ids, registry, faults);
    ObjectMaker maker(registry, ids, {}, faults);
    auto integrator = maker.make_as<Integrator>(root.children.front());
    faults.throw_all({});
    warnings.insert(warnings.end(), maker.warnings.begin(), maker.warnings.end());
    return integrator;
}

}  // namespace mote::core
