// The steps from a file to a scene, in order.
#include "core/formats/xml/scene_loader.h"

#include <algorithm>

#include "core/formats/xml/converted_scenes.h"
#include "core/formats/xml/element_checks.h"
#include "core/formats/xml/foreign_integrators.h"
#include "core/formats/xml/foreign_names.h"
#include "core/formats/xml/frame_files.h"
#include "core/formats/xml/lenient_scene.h"
#include "core/formats/xml/scene_builder.h"
#include "core/formats/xml/scene_defines.h"
#include "core/formats/xml/scene_making.h"
#include "core/formats/xml/scene_values.h"

namespace mote::core {
namespace {

/// Sensors without film or sampler get the default ones, so that -D film.width always has an aim.
void complete_sensors(Element& scene) {
    for (std::size_t i = 0; i < scene.children.size(); ++i) {
        if (scene.children[i].tag != "sensor") continue;
        Faults later;                                   // checked again, and reported then
        const IdTable ids = collect_ids(scene, later);  // holds pointers: anew for every change
        std::vector<std::string> tags;
        for (const Element& c : scene.children[i].children)
            later.attempt(c, [&] { tags.push_back(resolve(c, ids).tag); });
        for (const auto& [tag, type] : {std::pair("film", "hdrfilm"), std::pair("sampler", "sobol")}) {
            if (std::find(tags.begin(), tags.end(), tag) != tags.end()) continue;
            Element e;
            e.tag = tag, e.where = scene.children[i].where, e.folder = scene.children[i].folder;
            e.set("type", type);
            scene.children[i].children.push_back(e);
        }
    }
}

/// Elements in today's words, with every -D applied. What is wrong with the command line goes to `faults`.
void prepare(SceneDocument& document, SceneDefines& defines, const Registry& registry,
             const LoadOptions& options, Faults& faults) {
    Element& scene = document.scene;
    if (options.frame) number_files(scene, *options.frame);
    upgrade_legacy(scene, document.warnings);
    drop_foreign_elements(scene, document.warnings);
    replace_foreign_types(scene, registry, document.warnings);
    replace_foreign_integrators(document, registry);
    if (!options.integrator.empty())
        override_integrator(document, options.integrator, registry);
    else if (!options.default_integrator.empty())
        complete_integrator(document, options.default_integrator, registry);
    complete_sensors(scene);
    defines.check_all_used(faults);
    defines.apply_paths(scene, registry, faults);
}

constexpr int max_rounds = 100;  // of leniency; each mends what the one before brought to light

/// Checks the elements and makes the parts of them. Throws SceneErrors; with leniency only where mending does
/// not help.
Scene::Parts make_parts(SceneDocument& document, const Registry& registry, const std::string& file,
                        bool lenient, const Faults& of_command) {
    for (int round = 0;; ++round) {
        Faults faults = of_command;
        check_elements(document.scene, registry, document.warnings, faults);
        Scene::Parts parts = build_scene(document, registry, file, faults);
        if (faults.empty()) return parts;
        if (!lenient || !of_command.empty() || round == max_rounds) faults.throw_all(document.files);
        for (const std::string& note : remedy(document.scene, faults, registry))
            document.approximations.push_back(note);
    }
}

}  // namespace

std::unique_ptr<Scene> make_scene(SceneDocument document, SceneDefines& defines, const Registry& registry,
                                  const LoadOptions& options, const std::string& file,
                                  const std::function<void(Scene::Parts&)>& finish) {
    Faults faults;
    prepare(document, defines, registry, options, faults);
    std::vector<MemoryOfFile> files;  // opens each file, and for grids starts a program
    if (options.memory || options.report) files = memory_of_files(document, registry);
    if (options.memory) require_memory(files, *options.memory);
    Scene::Parts parts = make_parts(document, registry, file, options.lenient, faults);
    if (finish) finish(parts);
    auto scene = std::make_unique<Scene>(std::move(parts));
    if (options.report)
        *options.report = {document.approximations, document.features,
                           std::make_shared<const Element>(std::move(document.scene)), std::move(files)};
    return scene;
}

SceneDocument load_scene_elements(const std::string& path, const Registry& registry,
                                  const LoadOptions& options) {
    if (is_foreign_scene(path))
        throw InputError("is no XML: turn it into XML first (mote convert)", {path, 0});
    SceneDefines defines(options.defines);
    SceneDocument document = read_scene_file(path, defines);
    Faults faults;
    prepare(document, defines, registry, options, faults);
    if (options.lenient) {
        make_parts(document, registry, path, true, faults);
        return document;
    }
    check_elements(document.scene, registry, document.warnings, faults);
    check_references(document.scene, collect_ids(document.scene, faults), registry, faults);
    faults.throw_all(document.files);
    return document;
}

std::unique_ptr<Scene> load_scene(const std::string& path, const Registry& registry,
                                  const LoadOptions& options) {
    if (is_foreign_scene(path)) return load_converted_scene(path, registry, options);
    SceneDefines defines(options.defines);
    return make_scene(read_scene_file(path, defines), defines, registry, options, path);
}

std::unique_ptr<Scene> load_scene_from_string(const std::string& xml, const std::string& folder,
                                              const Registry& registry, const LoadOptions& options,
                                              const std::string& name) {
    SceneDefines defines(options.defines);
    return make_scene(read_scene_text(xml, folder, name, defines), defines, registry, options, name);
}

}  // namespace mote::core
