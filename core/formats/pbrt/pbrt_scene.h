// A pbrt-v4 scene in our language.
#pragma once

#include <filesystem>

#include "core/formats/conversion/conversion.h"

namespace mote::core {

/// True for names that end in .pbrt or .pbrt.gz.
bool is_pbrt(const std::string& path);

/// Writes meshes, grids and pictures into `folder`, which is there. Throws InputError for a file that breaks
/// the grammar, or cannot be written. What cannot be said in our language is reported.
ConvertedScene convert_pbrt(const std::string& path, const std::filesystem::path& folder,
                            const ConversionOptions& options);

}  // namespace mote::core
