// Reads any picture that a command line names: a layer of an EXR, or a bitmap.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/formats/pictures/image_file.h"
#include "session/output_files.h"

namespace mote::apps {

using session::extension_of;

struct PictureFile {
    core::Bitmap bitmap;
    std::vector<core::Rgb> variance;  ///< of the mean, pixel by pixel; empty where it is not known
    std::map<std::string, std::string> metadata;  ///< of an EXR; empty otherwise
};

/// Throws InputError for a folder, a pipe or a device where a file is needed.
void require_input(const std::string& path);

/// Report of --half that could not hold so many values.
std::string clamped_text(std::uint64_t values);

/// `layer`: "" is the beauty. Throws InputError naming the file, with the nearest layer there is.
PictureFile read_picture(const std::string& path, const std::string& layer);

}  // namespace mote::apps
