// Changes to a scene in the viewer: those of its integrator, which need no loading, and all others.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "session/loaded_scene.h"

namespace mote::viewer {

/// True for the path of a parameter of the integrator.
bool is_of_integrator(const std::string& path);
/// The changes without those of the integrator.
session::SceneChanges outside_integrator(session::SceneChanges changes);
/// Another integrator keeps no changes of the one before.
void set_integrator(session::SceneChanges& changes, const std::string& type);
/// Sets, replaces or (null) removes a definition. A nested object's own go with its type. Throws InputError
/// for a path or value that is none, and beyond a number of changes.
void set_define(session::SceneChanges& changes, const std::string& path, const nlohmann::json& value);

}  // namespace mote::viewer
