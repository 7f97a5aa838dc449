// Memory that textures of picture files will take (core/materials/texels.h), before they are read.
#include <algorithm>
#include <fstream>

#include "core/files/whole_file.h"
#include "core/formats/pictures/exr_preflight.h"
#include "core/formats/pictures/image_file.h"

namespace mote::core {

double bitmap_memory(const std::string& path) {
    const auto size = double(size_of_file(path));
    std::string head(26, '\0');
    std::ifstream(path, std::ios::binary).read(head.data(), std::streamsize(head.size()));
    const auto byte = [&](std::size_t at) { return double(static_cast<unsigned char>(head[at])); };
    const auto number = [&](std::size_t at) {  // the high byte first
        return ((byte(at) * 256.0 + byte(at + 1)) * 256.0 + byte(at + 2)) * 256.0 + byte(at + 3);
    };
    if (head.starts_with("\x76\x2f\x31\x01")) {
        const ExrSummary summary = check_exr_header(path);
        return double(summary.width) * double(summary.height) * 2.0;  // grey halves
    }
    if (!head.starts_with("\x89PNG\r\n\x1a\n")) return size;
    const bool wide = head[24] == 16, grey = head[25] == 0 || head[25] == 4;
    const double pixel = (wide ? 2.0 : 1.0) * (grey ? 1.0 : 3.0);
    constexpr double max_pixels_of_a_byte = 8.0 * 1032.0;  // of one bit, deflated
    return pixel * std::min(number(16) * number(20), size * max_pixels_of_a_byte);
}

}  // namespace mote::core
