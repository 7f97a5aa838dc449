// PNG previews that say something of themselves, in text chunks.
#pragma once

#include <map>
#include <string>

#include "core/formats/pictures/image_file.h"

namespace mote::core {

/// write_png(), with these words under their keys.
void write_png(const std::string& path, int width, int height, std::span<const Rgb> pixels, float exposure,
               const std::map<std::string, std::string>& text);

}  // namespace mote::core
