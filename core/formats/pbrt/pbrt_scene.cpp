// Puts the parts of a scene together.
#include "core/formats/pbrt/pbrt_scene.h"

#include <pugixml.hpp>
#include <sstream>

#include "core/formats/pbrt/pbrt_reader.h"

namespace mote::core {

bool is_pbrt(const std::string& path) {
    std::string name = path;
    for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
    return name.ends_with(".pbrt") || name.ends_with(".pbrt.gz");
}

ConvertedScene convert_pbrt(const std::string& path, const std::filesystem::path& folder,
                            const ConversionOptions& options) {
    ConvertedScene scene{{}, ConversionReport(path), {}};
    PbrtFiles files(path, folder, options, scene);
    pugi::xml_document document;
    pugi::xml_node root = document.append_child("scene");
    root.append_attribute("version") = "3.0.0";
    PbrtReader(root, files).read(std::filesystem::path(path).filename().string());
    std::ostringstream text;
    document.save(text, "    ");
    scene.xml = text.str();
    return scene;
}

}  // namespace mote::core
