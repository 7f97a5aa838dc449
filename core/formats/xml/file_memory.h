// Memory that the files of a scene will take, by their headers, before any is loaded.
#pragma once

#include <string>
#include <vector>

#include "core/formats/xml/xml_reader.h"
#include "core/objects/memory_budget.h"
#include "core/objects/registry.h"

namespace mote::core {

struct MemoryOfFile {
    std::string path;
    double bytes = 0.0;  ///< at least, of all objects that are made of it
};

/// Files of types that report it (Registry::file_memory()), the largest first. An element that stands there
/// twice with the same values counts once. A file that cannot be read counts nothing: loading reports it.
std::vector<MemoryOfFile> memory_of_files(const SceneDocument& document, const Registry& registry);

/// [B]
double sum_of(const std::vector<MemoryOfFile>& files);
/// "3.1 GB: forest.ply 2.0 GB, cloud.vdb 0.9 GB, ..."
std::string memory_summary(const std::vector<MemoryOfFile>& files);

/// Throws OutOfMemory where they do not fit, with the files without which the rest does.
void require_memory(const std::vector<MemoryOfFile>& files, const MemoryBudget& memory);

}  // namespace mote::core
