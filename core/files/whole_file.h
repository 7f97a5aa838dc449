// A file as bytes.
#pragma once

#include <string>
#include <vector>

namespace mote::core {

/// Throws InputError, without the file's name, for a folder, a pipe or a device: opening a pipe would wait
/// for a writer. No error where there is no such file: opening it will be one.
void require_file(const std::string& path);

/// Throws InputError with the system's reason, without the file's name: callers add the file's role.
std::vector<std::byte> read_whole_file(const std::string& path);

}  // namespace mote::core
