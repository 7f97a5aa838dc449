// Knobs of a scene: declared parameters of its integrator, media and lights, each with the path
// by which `-D` sets it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "session/loaded_scene.h"

namespace mote::viewer {

/// Elements of a scene that was loaded without changes to its integrator, with all of `changes`. Those that
/// fit no element are left out.
core::Element changed_elements(const session::LoadedScene& scene, const session::SceneChanges& changes);

/// Groups {"title", "kind", "knobs": [{"path", "name", "type", "value", "default", "lower", "upper", "unit",
/// "choices", "sentence"}]}. The value is the text in the scene, "" where it says nothing. "type" is boolean,
/// integer, float, string, rgb, or object, whose choices are types.
nlohmann::json scene_knobs(const core::Element& elements, const core::Registry& registry);

/// Origin, target and up of the scene's camera, as `-D sensor.to_world` takes them; the target is the middle
/// of what the image shows at its centre.
nlohmann::json camera_view(const session::LoadedScene& scene);

/// The elements of a scene as an XML file, which belongs beside the scene's own.
std::string scene_xml(const core::Element& scene);

}  // namespace mote::viewer
