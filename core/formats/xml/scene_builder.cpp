// Collects what stands directly in <scene>.
#include "core/formats/xml/scene_builder.h"

#include <algorithm>
#include <set>

#include "core/formats/xml/object_maker.h"
#include "core/geometry/instances.h"
#include "core/render/integrator.h"

namespace mote::core {
namespace {

/// Each once, in the order of the first mention.
std::vector<std::string> unique(const std::vector<std::string>& texts) {
    std::vector<std::string> result;
    std::set<std::string> seen;
    for (const std::string& text : texts)
        if (seen.insert(text).second) result.push_back(text);
    return result;
}

/// Puts what stands directly in <scene> into its place.
struct Builder {
    ObjectMaker maker;
    Faults& faults;
    Scene::Parts parts;
    std::vector<std::pair<std::shared_ptr<Emitter>, const Element*>> lights;
    bool integrator_met = false;

    void add(const Element& e) {
        if (e.tag == "shape") {
            add_shapes(e);
        } else if (e.tag == "emitter") {
            auto light = maker.make_as<Emitter>(e);
            if (!light) return;
            lights.emplace_back(light, &e);
            if (light->traits().kind != EmitterKind::area) parts.emitters.push_back(std::move(light));
        } else if (e.tag == "sensor") {
            if (once(e, bool(parts.camera))) parts.camera = maker.make_as<Camera>(e);
        } else if (e.tag == "integrator") {
            add_integrator(e);
        } else if (find_category(e.tag)) {
            maker.make(e);  // checked even when nothing refers to it
        }
    }
    /// The first makes the picture; others are what the scene sets for methods of other types.
    void add_integrator(const Element& e) {
        const auto same = [&](const auto& other) { return other->get("type") == e.get("type"); };
        if (!integrator_met) {
            integrator_met = true;
            parts.integrator = maker.make_as<Integrator>(e);
            parts.integrator_element = std::make_shared<const Element>(e);
            return;
        }
        auto& further = parts.further_integrators;
        if (!once(e, same(parts.integrator_element) || std::any_of(further.begin(), further.end(), same)))
            return;
        maker.make_as<Integrator>(e);
        further.push_back(std::make_shared<const Element>(e));
    }
    /// A shape, or those that an instance places; a group alone is not seen.
    void add_shapes(const Element& e) {
        const std::shared_ptr<Object> object = maker.make(e);
        if (!object) return;
        if (auto shape = std::dynamic_pointer_cast<Shape>(object)) {
            parts.shapes.push_back(shape);
            if (shape->emitter) parts.emitters.push_back(shape->emitter);
        } else if (const auto instance = std::dynamic_pointer_cast<Instance>(object)) {
            parts.shapes.insert(parts.shapes.end(), instance->shapes.begin(), instance->shapes.end());
        } else if (!std::dynamic_pointer_cast<ShapeGroup>(object)) {
            faults.add(&e, InputError("<shape> is an object of the wrong kind", e.where));
        }
    }
    bool once(const Element& e, bool taken) {
        const std::string type = e.tag == "integrator" ? " of type '" + printable(e.get("type")) + "'" : "";
        if (taken) faults.add(&e, InputError("the scene has more than one " + e.tag + type, e.where));
        return !taken;
    }
    /// Area lights that no shape took up.
    void check_area_lights() {
        if (!faults.empty()) return;  // the shape may be one that could not be made
        std::set<const Emitter*> taken;
        for (const auto& shape : parts.shapes) taken.insert(shape->emitter.get());
        for (const auto& [light, element] : lights)
            if (light->traits().kind == EmitterKind::area && !taken.count(light.get()))
                faults.add(element, InputError("an area light must be nested in a shape", element->where));
    }
};

}  // namespace

Scene::Parts build_scene(const SceneDocument& document, const Registry& registry, const std::string& file,
                         Faults& faults) {
    const IdTable ids = collect_ids(document.scene, faults);
    check_references(document.scene, ids, registry, faults);
    Builder builder{ObjectMaker(registry, ids, document.search_paths, faults), faults, {}, {}, false};
    for (const Element& e : document.scene.children) builder.add(e);
    builder.check_area_lights();
    const ObjectMaker& maker = builder.maker;
    Scene::Parts parts = std::move(builder.parts);
    parts.file = file;
    parts.media = maker.media;
    parts.film = maker.film;
    parts.input_files = document.files;
    parts.input_files.insert(parts.input_files.end(), maker.files.begin(), maker.files.end());
    parts.input_files = unique(parts.input_files);
    parts.warnings = document.warnings;
    parts.warnings.insert(parts.warnings.end(), maker.warnings.begin(), maker.warnings.end());
    parts.warnings = unique(parts.warnings);
    return parts;
}

Scene::Parts build_scene(const SceneDocument& document, const Registry& registry, const std::string& file) {
    Faults faults;
    Scene::Parts parts = build_scene(document, registry, file, faults);
    faults.throw_all(document.files);
    return parts;
}

}  // namespace mote::core
