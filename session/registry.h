// Every part that mote has, for the scene loader.
#pragma once

#include <span>
#include <string>

#include "core/objects/registry.h"

namespace mote::session {

/// All types of all folders, with their manual pages, and those of plugins: of MOTE_PLUGINS, and of these
/// files. Throws core::InputError as load_plugin() does.
core::Registry make_registry(std::span<const std::string> plugins = {});

}  // namespace mote::session
