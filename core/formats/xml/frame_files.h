// Files of a sequence: smoke.####.vdb is smoke.0007.vdb in frame 7.
#pragma once

#include <optional>
#include <string>

#include "core/formats/xml/scene_element.h"

namespace mote::core {

/// A name around its placeholder for a frame's number: the longest run of two or more '#'.
struct FramePlaceholder {
    std::string before, after;
    std::size_t digits = 0;  ///< at least, filled up with zeros

    std::string with(long number) const;  ///< the name of that frame
};
/// Nothing where there is no such run.
std::optional<FramePlaceholder> frame_placeholder(const std::string& name);

/// Puts the number into every file name of the scene that has a placeholder for one.
void number_files(Element& scene, int number);

}  // namespace mote::core
