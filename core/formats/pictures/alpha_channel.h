// The fourth channel of a picture.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mote::core {

/// Alpha as it is stored, 0 to 1, row by row from the top; empty where the picture has none. Throws
/// InputError as read_bitmap() does.
std::vector<float> read_alpha(const std::string& path, std::size_t max_pixels = std::size_t(1) << 28);

}  // namespace mote::core
