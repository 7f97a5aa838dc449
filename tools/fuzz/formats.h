// Every format that mote reads, as a function from a file to "read" or "refused".
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace mote::fuzz {

using Bytes = std::vector<std::uint8_t>;

struct Format {
    std::string name;       ///< "ply", "checkpoint"
    std::string extension;  ///< of the file that is read, ".ply"
    std::string reader;     ///< its reader, for the table: "mote", "libpng", "OpenEXR", ...
    /// Reads the file to the end of what mote does with it. Throws InputError where it refuses; whatever else
    /// it throws is a defect.
    std::function<void(const std::string& path)> read;
    /// Files that are right, made here.
    std::function<std::vector<Bytes>()> seeds;
    /// Makes checksums fit again, so that damage reaches what lies behind them; may be empty.
    std::function<void(Bytes&)> forge;
    bool text = false;     ///< damaged word by word as well
    std::size_t head = 0;  ///< only the first bytes are damaged; 0: all
};

/// In the order of the table. `folder`: where files that others name lie (see write_neighbours()).
std::vector<Format> formats();
/// Throws std::invalid_argument with the known names for an unknown one.
const Format& find_format(const std::vector<Format>& all, const std::string& name);

/// Small files that the scenes among the seeds name.
void write_neighbours(const std::string& folder);

enum class Outcome : std::uint8_t { read, refused, defect };
/// One file, read; `message` holds what was thrown.
Outcome try_file(const Format& format, const std::string& path, std::string& message);

}  // namespace mote::fuzz
