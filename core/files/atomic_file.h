// Files that are whole or not there: written beside their final name, and renamed.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace mote::core {

/// Writes bytes beside the final name, syncs and renames. Throws InputError with the system's reason.
void write_file_atomically(const std::string& path, std::span<const std::byte> bytes);
/// Writes the pieces one after the other beside the final name, syncs and renames. Throws InputError with the
/// system's reason.
void write_file_atomically(const std::string& path, std::span<const std::span<const std::byte>> pieces);

}  // namespace mote::core
