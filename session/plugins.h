// Types of the scene language from shared libraries (core/objects/plugin.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/objects/registry.h"

namespace mote::session {

/// Files of plugins: those in the variable MOTE_PLUGINS, separated by colons, then `files`.
std::vector<std::string> plugin_files(std::span<const std::string> files);

/// Adds the types of a plugin, which stays loaded until the program ends. Throws core::InputError, which
/// names the file, where it cannot be loaded, is no plugin, was compiled for another interface (both are
/// named), or adds a type that is there already.
void load_plugin(core::Registry& registry, const std::string& file);

/// The checksum of every plugin: their code determines the bits of a picture.
std::vector<std::string> plugin_settings(std::span<const std::string> files);

}  // namespace mote::session
