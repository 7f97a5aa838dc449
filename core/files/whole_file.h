// A file as bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/objects/memory_budget.h"

namespace mote::core {

/// Throws InputError, without the file's name, for a folder, a pipe or a device: opening a pipe would wait
/// for a writer. No error where there is no such file: opening it will be one.
void require_file(const std::string& path);

/// Size of a file [B]. Throws InputError, without the file's name, where there is none.
std::uint64_t size_of_file(const std::string& path);

/// Throws InputError with the system's reason, without the file's name: callers add the file's role. Throws
/// OutOfMemory where the bytes, and as many for what is made of them, exceed the budget.
std::vector<std::byte> read_whole_file(const std::string& path, const MemoryBudget& memory = {});

}  // namespace mote::core
