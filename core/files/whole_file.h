// A file as bytes.
#pragma once

#include <string>
#include <vector>

namespace mote::core {

/// Throws InputError, without the file's name, for a folder, a pipe or a device: opening a pipe would wait
/// for whoever writes to it. Says nothing where there is no such file: opening it will.
void require_file(const std::string& path);

/// Throws InputError with the system's reason, without the file's name: callers know what the file was to be.
std::vector<std::byte> read_whole_file(const std::string& path);

}  // namespace mote::core
