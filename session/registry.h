// Every part that mote has, for the scene loader.
#pragma once

#include "core/objects/registry.h"

namespace mote::session {

/// All types of all folders, with their manual pages.
core::Registry make_registry();

}  // namespace mote::session
