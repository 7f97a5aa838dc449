// From XML text to a tree of elements with file and line: includes are read, $parameters are replaced.
#pragma once

#include <string>
#include <vector>

#include "core/loading/scene_defines.h"
#include "core/loading/scene_element.h"

namespace mote::core {

struct SceneDocument {
    Element scene;                          ///< includes spliced in; no <include>, <default> or <path> left
    std::vector<std::string> files;         ///< every XML file read
    std::vector<std::string> search_paths;  ///< the scene's folder, then those of <path>
    std::vector<std::string> warnings;
};

/// Throws InputError with file and line for a file that cannot be read, malformed XML, a cycle of includes,
/// or more than the limits: 64 MB a file, 64 elements deep, 16 includes deep, 1000 files, 4 million elements.
SceneDocument read_scene_file(const std::string& path, SceneDefines& defines);
SceneDocument read_scene_text(const std::string& xml, const std::string& folder, const std::string& name,
                              SceneDefines& defines);

}  // namespace mote::core
