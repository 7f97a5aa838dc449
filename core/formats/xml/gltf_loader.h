// glTF scenes: converted into our language in a folder of their own, then loaded as every scene is.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/formats/gltf/gltf_scene.h"
#include "core/formats/xml/scene_loader.h"

namespace mote::core {

/// Takes the definitions that are meant for the conversion: `camera` and `emission`. Throws InputError for a
/// value that is none.
GltfOptions take_gltf_options(std::vector<std::pair<std::string, std::string>>& defines);

/// Anything without a counterpart in our language as errors, all of them; or with leniency as lines for the
/// report.
std::vector<std::string> gltf_approximations(const GltfScene& scene, const std::string& path, bool lenient);

/// load_scene() for a .gltf or .glb file. Lines in messages are those of the scene that `mote convert`
/// writes.
std::unique_ptr<Scene> load_gltf_scene(const std::string& path, const Registry& registry,
                                       const LoadOptions& options);

}  // namespace mote::core
