// From checked elements to objects: references, defaults, and the parts of a scene.
#pragma once

#include "core/formats/xml/element_checks.h"
#include "core/formats/xml/xml_reader.h"
#include "core/scene/scene.h"

namespace mote::core {

/// `file` is its name in messages and in Parts::file. What is wrong goes to `faults`; the parts are whole
/// where nothing is.
Scene::Parts build_scene(const SceneDocument& document, const Registry& registry, const std::string& file,
                         Faults& faults);
/// Builds the scene; throws SceneErrors.
Scene::Parts build_scene(const SceneDocument& document, const Registry& registry, const std::string& file);

}  // namespace mote::core
