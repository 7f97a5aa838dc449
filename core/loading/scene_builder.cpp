// Collects what stands directly in <scene>.
#include "core/loading/scene_builder.h"

#include <set>

#include "core/loading/object_maker.h"
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

/// Area lights that no shape took up.
void check_area_lights(const std::vector<std::pair<std::shared_ptr<Emitter>, SourceLocation>>& lights,
                       const Scene::Parts& parts) {
    std::set<const Emitter*> taken;
    for (const auto& shape : parts.shapes) taken.insert(shape->emitter.get());
    for (const auto& [light, where] : lights)
        if (light->traits().kind == EmitterKind::area && !taken.count(light.get()))
            throw InputError("an area light must be nested in a shape", where);
}

}  // namespace

Scene::Parts build_scene(const SceneDocument& document, const Registry& registry, const std::string& file) {
    const IdTable ids = collect_ids(document.scene);
    check_references(document.scene, ids, registry);
    ObjectMaker maker(registry, ids, document.search_paths);
    Scene::Parts parts;
    parts.file = file;
    std::vector<std::pair<std::shared_ptr<Emitter>, SourceLocation>> lights;
    for (const Element& e : document.scene.children) {
        if (e.tag == "alias") continue;
        if (e.tag == "shape") {
            parts.shapes.push_back(maker.make_as<Shape>(e));
            if (parts.shapes.back()->emitter) parts.emitters.push_back(parts.shapes.back()->emitter);
        } else if (e.tag == "emitter") {
            lights.emplace_back(maker.make_as<Emitter>(e), e.where);
            if (lights.back().first->traits().kind != EmitterKind::area)
                parts.emitters.push_back(lights.back().first);
        } else if (e.tag == "sensor") {
            if (parts.camera) throw InputError("the scene has more than one sensor", e.where);
            parts.camera = maker.make_as<Camera>(e);
        } else if (e.tag == "integrator") {
            if (parts.integrator) throw InputError("the scene has more than one integrator", e.where);
            parts.integrator = maker.make_as<Integrator>(e);
            parts.integrator_element = std::make_shared<const Element>(e);
        } else {
            maker.make(e);  // checked even when nothing refers to it
        }
    }
    check_area_lights(lights, parts);
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

}  // namespace mote::core
