// The $parameters of scene files: <default> elements and -D name=value from the command line.
//
// A name with a dot is a path into the scene ("film.width") and is applied once the file has been read.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/formats/xml/scene_element.h"

namespace mote::core {

class Faults;
class Registry;

class SceneDefines {
  public:
    explicit SceneDefines(const std::vector<std::pair<std::string, std::string>>& defines);

    /// Replaces every $name in `text`. Throws InputError for a name that nothing defines.
    std::string substitute(const std::string& text, const SourceLocation& where);
    /// <default>: sets the parameter unless it has a value already.
    void set_default(const std::string& name, const std::string& value);
    /// Applies the paths to the elements of the scene. It is a fault when a path fits no element, several, or
    /// names a parameter that the element's type does not have.
    void apply_paths(Element& scene, const Registry& registry, Faults& faults) const;
    /// A -D that no $parameter used is a fault, with the nearest known name.
    void check_all_used(Faults& faults) const;

  private:
    struct Entry {
        std::string value;
        bool from_command_line = false, used = false;
    };
    std::map<std::string, Entry> parameters_;
    std::vector<std::pair<std::string, std::string>> paths_;
};

/// Sets one value below `root`, as -D does with the same path. Throws InputError.
void set_by_path(Element& root, const std::string& path, const std::string& value, const Registry& registry,
                 const SourceLocation& where);

}  // namespace mote::core
