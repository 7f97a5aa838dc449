// Files of a sequence: smoke.####.vdb is smoke.0007.vdb in frame 7.
#pragma once

#include <optional>
#include <string>

#include "core/formats/xml/scene_element.h"

namespace mote::core {

/// The longest run of two or more '#' replaced by the number, with as many digits at least; nothing where
/// there is no such run.
std::optional<std::string> with_frame_number(const std::string& name, int number);

/// Puts the number into every file name of the scene that has a placeholder for one.
void number_files(Element& scene, int number);

}  // namespace mote::core
