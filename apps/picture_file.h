// Reads any picture that a command line names: a layer of an EXR, or a bitmap.
#pragma once

#include <map>
#include <string>

#include "core/image/image_file.h"

namespace mote::apps {

struct PictureFile {
    core::Bitmap bitmap;
    std::map<std::string, std::string> metadata;  ///< of an EXR; empty otherwise
};

/// The extension in lower case, ".exr".
std::string extension_of(const std::string& path);

/// `layer`: "" is the beauty. Throws InputError naming the file, with the nearest layer there is.
PictureFile read_picture(const std::string& path, const std::string& layer);

}  // namespace mote::apps
