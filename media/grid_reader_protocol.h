// Answer of the helper program that reads VDB files: a header, the NanoVDB buffer, and a JSON text, in a
// memory file that it inherits. The grid is made in the file's pages, which mote then maps: a copy of either
// process would touch as much memory again. The header is written last, so that a helper that died leaves
// none.
#pragma once

#include <cstdint>

namespace mote::media {

struct GridReaderHeader {
    static constexpr std::uint64_t expected_magic = 0x3352444952474d4full;
    std::uint64_t magic = 0;
    std::uint64_t text_offset = 0;  ///< of the JSON from the start of the file
    std::uint64_t text_size = 0;    ///< its bytes
    std::uint64_t grid_offset = 0;  ///< of the NanoVDB buffer from the start of the file: whole pages
    std::uint64_t grid_size = 0;    ///< 0: no grid
};

inline constexpr int grid_reader_descriptor = 3;                ///< the memory file in the helper
inline constexpr std::uint64_t grid_reader_max_text = 1 << 24;  ///< longer answers are refused

// Arguments: mode ("read", "list" or "sizes"), file, memory limit [bytes], CPU limit [s], clamp negatives
// ("0"/"1"), grid name. The JSON is {"error": "..."} or, for "read", name, active_voxels, clamped,
// index_to_world (16 numbers, columns), warnings; for "list", {"grids": [...]}; for "sizes", {"bytes": ...}
// of one grid, from metadata alone.

}  // namespace mote::media
