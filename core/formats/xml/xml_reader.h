// From XML text to a tree of elements with file and line: includes are read, $parameters are replaced.
#pragma once

#include <string>
#include <vector>

#include "core/formats/xml/scene_defines.h"
#include "core/formats/xml/scene_element.h"

namespace mote::core {

struct SceneDocument {
    Element scene;                          ///< includes spliced in; no <include>, <default> or <path> left
    std::vector<std::string> files;         ///< every XML file read
    std::vector<std::string> search_paths;  ///< the scene's folder, then those of <path>
    std::vector<std::string> warnings;
    std::vector<std::string> features;        ///< layers of the first hit that the scene requests
    std::vector<std::string> approximations;  ///< left out or replaced by leniency
};

/// Throws InputError with file and line for a file that cannot be read, malformed XML, or more than the
/// limits: 64 MB a file, 64 elements deep, 4 million elements. All else that is wrong (a name that nothing
/// defines, a cycle of includes, more than 16 includes deep or 1000 files) is the fault of its element.
SceneDocument read_scene_file(const std::string& path, SceneDefines& defines);
SceneDocument read_scene_text(const std::string& xml, const std::string& folder, const std::string& name,
                              SceneDefines& defines);

}  // namespace mote::core
