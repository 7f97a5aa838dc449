// The page docs/scene-format.md: an introduction to the language, and every type from its manual page.
#pragma once

#include <string>

#include "core/objects/registry.h"

namespace mote::core {

std::string scene_format_markdown(const Registry& registry);

}  // namespace mote::core
