// Every plugin of Mitsuba 3.9.1, and what becomes of it here: the table of docs/scene-format.md.
#pragma once

#include <string>
#include <vector>

#include "core/objects/registry.h"

namespace mote::core {

struct MitsubaFeature {
    Category category;
    std::string type;
    std::string state;  ///< supported, approximated or refused; from the registry and the loader's own tables
    std::string remark;  ///< by what, or why not
};

/// By category, then by name. Whatever is in the registry is supported.
std::vector<MitsubaFeature> mitsuba_features(const Registry& registry);
/// The list as a table of a manual page.
std::string mitsuba_features_markdown(const Registry& registry);

}  // namespace mote::core
