// A glTF 2.0 scene in our language: an XML text, and the meshes and pictures that it names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/formats/gltf/gltf_report.h"

namespace mote::core {

struct GltfOptions {
    std::string camera;     ///< its name; "": the first one
    double emission = 1.0;  ///< multiplies what materials emit
    /// Written before the names of files in the XML: "scene_files/", where the XML stands beside that folder.
    std::string prefix;
    bool copy_pictures = false;  ///< else pictures beside the glTF file are named where they are
};

struct GltfScene {
    std::string xml;
    GltfReport report;
    std::vector<std::string> files;  ///< all that was read, the glTF file first
};

/// True for names that end in .gltf or .glb.
bool is_gltf(const std::string& path);

/// Writes meshes and pictures into `folder`, which is there. Throws InputError for files that are damaged or
/// cannot be written. What cannot be said in our language is reported.
GltfScene convert_gltf(const std::string& path, const std::filesystem::path& folder,
                       const GltfOptions& options);

}  // namespace mote::core
