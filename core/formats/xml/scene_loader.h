// From an XML file to a Scene: a documented subset of Mitsuba 3's language (docs/scene-format.md).
//
// Three steps, each in a file of its own: xml_reader (text -> elements with file and line; include, default,
// $parameters, camelCase of version 0.x), element checks against the registry's manual pages, and
// scene_builder (elements -> objects, references, scene). Every fault is an InputError with file, line and
// the nearest known name; all those of a scene come together as SceneErrors (faults.h).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/formats/xml/file_memory.h"
#include "core/formats/xml/xml_reader.h"
#include "core/objects/error.h"
#include "core/objects/registry.h"
#include "core/scene/scene.h"

namespace mote::core {

/// Files, warnings and approximations of loading.
struct LoadReport {
    std::vector<std::string> approximations;  ///< left out or replaced by leniency, and why
    std::vector<std::string> features;        ///< layers of the first hit that the file requests
    std::shared_ptr<const Element> elements;  ///< of the scene, in today's words, with every -D applied
    std::vector<MemoryOfFile> files = {};     ///< what files take, by their headers
};

/// Changes of a scene by the caller, and how strictly it is read.
struct LoadOptions {
    /// -D name=value: `name` is a $parameter of the file, or a path such as "integrator.paths" or
    /// "film.width". One that nothing used is an error.
    std::vector<std::pair<std::string, std::string>> defines;
    /// Replaces the type of the file's integrator; its parameters are kept where the new type has them, and
    /// whatever is wrong with them is a warning.
    std::string integrator;
    /// Stands in where the file has no integrator, or one of a type that is not known (a warning); empty: the
    /// scene has none then, or the type is an error.
    std::string default_integrator = {};
    /// Lenient: what is wrong with the file is left out or approximated, as LoadReport::approximations says.
    bool lenient = false;
    /// Number of the frame of a sequence, in file names such as smoke.####.vdb.
    std::optional<int> frame = {};
    /// Files that need more are refused before one is read; none: not compared.
    std::optional<MemoryBudget> memory = {};
    LoadReport* report = nullptr;  ///< filled where it is not null
};

/// The scene of a file: XML, glTF or pbrt. Throws InputError; SceneErrors where several faults were found.
std::unique_ptr<Scene> load_scene(const std::string& path, const Registry& registry,
                                  const LoadOptions& options = {});
/// The first two steps alone, for writers of scenes: elements in today's words, every -D applied,
/// checked against the manual pages. build_scene() makes the scene of them.
SceneDocument load_scene_elements(const std::string& path, const Registry& registry,
                                  const LoadOptions& options = {});
/// Loads a scene from text; relative file names are looked up in `folder`. `name` is the file's name in
/// messages.
std::unique_ptr<Scene> load_scene_from_string(const std::string& xml, const std::string& folder,
                                              const Registry& registry, const LoadOptions& options = {},
                                              const std::string& name = "<string>");

}  // namespace mote::core
