// A file as bytes.
#pragma once

#include <string>
#include <vector>

namespace mote::core {

/// Throws InputError with the system's reason, without the file's name: callers know what the file was to be.
std::vector<std::byte> read_whole_file(const std::string& path);

}  // namespace mote::core
