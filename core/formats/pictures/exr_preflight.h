// Checks of the header of an untrusted OpenEXR file before the library reads it.
//
// The library allocates what a header declares, and looks for every chunk that it promises, before it finds
// out that the file is a hundred bytes long. This walk over the header trusts nothing: every size that is
// declared is held against the size of the file and against fixed limits.
#pragma once

#include <cstdint>
#include <string>

namespace mote::core {

struct ExrSummary {
    int part = 0;  ///< the first part that is an image (not deep data)
    std::int64_t width = 0, height = 0, channels = 0;
    bool tiled = false, mip_mapped = false;
    int parts = 1;
    std::string compression;
};

/// Throws InputError naming the file for anything that no sound file has, or that is larger than the limits:
/// 2^28 pixels, 1024 channels, 4 GiB of float planes, 1 GiB for one chunk.
ExrSummary check_exr_header(const std::string& path);

}  // namespace mote::core
