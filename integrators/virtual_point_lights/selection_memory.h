// What a selection of virtual point lights takes in memory, to be known before any of it is asked for.
#pragma once

#include "integrators/virtual_point_lights/vpl_selection.h"

namespace mote::integrators {

/// At most, while what selects among so many lights is built, besides the lights themselves; tables that
/// stand beside it afterwards are counted with it.
std::size_t selection_bytes(const SelectionSettings& settings, std::size_t lights);

/// Throws core::InputError where that is more than max_megabytes.
void check_selection_memory(const SelectionSettings& settings, std::size_t lights);

}  // namespace mote::integrators
