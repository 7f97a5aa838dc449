// The steps from a file to a scene, in order.
#include "core/loading/scene_loader.h"

#include <algorithm>

#include "core/loading/element_checks.h"
#include "core/loading/foreign_names.h"
#include "core/loading/scene_builder.h"
#include "core/loading/scene_defines.h"
#include "core/loading/scene_values.h"

namespace mote::core {
namespace {

/// The type that the command line asks for, with the parameters of the file that this type knows.
void replace_integrator(Element& scene, const std::string& type, const Registry& registry) {
    Element* element = scene.child_with_tag("integrator");
    if (!element) {
        Element fresh;
        fresh.tag = "integrator";
        fresh.where = scene.where, fresh.folder = scene.folder;
        scene.children.push_back(fresh);
        element = &scene.children.back();
    }
    element->set("type", type);
    if (!registry.find(Category::integrator, type)) element->where = {"--integrator " + printable(type), 0};
    const Manual& manual = require_manual(*element, registry);
    std::erase_if(element->children, [&](const Element& c) { return !has_place_for(manual, c); });
}

/// Sensors without film or sampler get the default ones, so that -D film.width always has an aim.
void complete_sensors(Element& scene) {
    for (std::size_t i = 0; i < scene.children.size(); ++i) {
        if (scene.children[i].tag != "sensor") continue;
        const IdTable ids = collect_ids(scene);  // holds pointers: anew for every change
        std::vector<std::string> tags;
        for (const Element& c : scene.children[i].children) tags.push_back(resolve(c, ids).tag);
        for (const auto& [tag, type] : {std::pair("film", "hdrfilm"), std::pair("sampler", "sobol")}) {
            if (std::find(tags.begin(), tags.end(), tag) != tags.end()) continue;
            Element e;
            e.tag = tag, e.where = scene.children[i].where, e.folder = scene.children[i].folder;
            e.set("type", type);
            scene.children[i].children.push_back(e);
        }
    }
}

void prepare(SceneDocument& document, SceneDefines& defines, const Registry& registry,
             const LoadOptions& options) {
    Element& scene = document.scene;
    upgrade_legacy(scene, document.warnings);
    replace_foreign_types(scene, registry, document.warnings);
    if (!options.integrator.empty()) replace_integrator(scene, options.integrator, registry);
    complete_sensors(scene);
    defines.check_all_used();
    defines.apply_paths(scene, registry);
    check_elements(scene, registry, document.warnings);
}

}  // namespace

SceneDocument load_scene_elements(const std::string& path, const Registry& registry,
                                  const LoadOptions& options) {
    SceneDefines defines(options.defines);
    SceneDocument document = read_scene_file(path, defines);
    prepare(document, defines, registry, options);
    return document;
}

std::unique_ptr<Scene> load_scene(const std::string& path, const Registry& registry,
                                  const LoadOptions& options) {
    return std::make_unique<Scene>(build_scene(load_scene_elements(path, registry, options), registry, path));
}

std::unique_ptr<Scene> load_scene_from_string(const std::string& xml, const std::string& folder,
                                              const Registry& registry, const LoadOptions& options,
                                              const std::string& name) {
    SceneDefines defines(options.defines);
    SceneDocument document = read_scene_text(xml, folder, name, defines);
    prepare(document, defines, registry, options);
    return std::make_unique<Scene>(build_scene(document, registry, name));
}

}  // namespace mote::core
