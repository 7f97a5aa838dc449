// A glTF 2.0 scene in our language.
#pragma once

#include <filesystem>

#include "core/formats/conversion/conversion.h"

namespace mote::core {

/// True for names that end in .gltf or .glb.
bool is_gltf(const std::string& path);

/// Writes meshes and pictures into `folder`, which is there. Throws InputError for files that are damaged or
/// cannot be written. What cannot be said in our language is reported.
ConvertedScene convert_gltf(const std::string& path, const std::filesystem::path& folder,
                            const ConversionOptions& options);

}  // namespace mote::core
