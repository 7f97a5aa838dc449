// A scene of another format in our language: an XML text, and the meshes and pictures that it names.
#pragma once

#include <string>
#include <vector>

#include "core/formats/conversion/conversion_report.h"

namespace mote::core {

struct ConversionOptions {
    std::string camera;     ///< glTF: its name; "": the first one
    double emission = 1.0;  ///< glTF: multiplies what materials emit
    /// Written before the names of files in the XML: "scene_files/", where the XML stands beside that folder.
    std::string prefix;
    bool copy_files = false;  ///< else files beside the foreign scene are named where they are
};

struct ConvertedScene {
    std::string xml;
    ConversionReport report;
    std::vector<std::string> files;  ///< all that was read, the scene itself first
};

}  // namespace mote::core
