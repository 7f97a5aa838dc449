// Scenes of other formats: converted into our language in a folder of their own, then loaded as every scene
// is.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/formats/conversion/conversion.h"
#include "core/formats/xml/scene_loader.h"

namespace mote::core {

/// True for glTF (.gltf, .glb) and pbrt (.pbrt, .pbrt.gz).
bool is_foreign_scene(const std::string& path);

/// Writes meshes and pictures into `folder`, which is there. Throws InputError for files that are damaged or
/// cannot be written. What cannot be said in our language is reported.
ConvertedScene convert_foreign_scene(const std::string& path, const std::filesystem::path& folder,
                                     const ConversionOptions& options);

/// Takes the definitions that are meant for the conversion: `camera` and `emission` of a glTF scene. Throws
/// InputError for a value that is none.
ConversionOptions take_conversion_options(const std::string& path,
                                          std::vector<std::pair<std::string, std::string>>& defines);

/// Anything without a counterpart in our language as errors, all of them; or with leniency as lines for the
/// report.
std::vector<std::string> approximations_of(const ConvertedScene& scene, bool lenient);

/// load_scene() for a foreign scene. Lines in messages are those of the scene that `mote convert` writes.
std::unique_ptr<Scene> load_converted_scene(const std::string& path, const Registry& registry,
                                            const LoadOptions& options);

}  // namespace mote::core
