// Shared by loaders of different files: from a document to a scene.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/formats/xml/scene_loader.h"

namespace mote::core {

/// `file` is the scene's name. `finish` may change the parts before the scene is made of them.
std::unique_ptr<Scene> make_scene(SceneDocument document, SceneDefines& defines, const Registry& registry,
                                  const LoadOptions& options, const std::string& file,
                                  const std::function<void(Scene::Parts&)>& finish = {});

}  // namespace mote::core
