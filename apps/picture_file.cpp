// Pictures that commands take.
#include "apps/picture_file.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/files/whole_file.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "session/reference_metadata.h"

namespace mote::apps {

using namespace session;

using core::ImageChannels, core::InputError;

void require_input(const std::string& path) {
    try {
        core::require_file(path);
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    }
}

namespace {

// By its first bytes: names lie.
bool is_exr(const std::string& path) {
    char magic[4] = {};
    std::ifstream(path, std::ios::binary).read(magic, 4);
    return std::memcmp(magic, "\x76\x2f\x31\x01", 4) == 0;
}

std::vector<std::string> layers_of(const ImageChannels& image) {
    std::vector<std::string> layers;
    for (const std::string& name : image.names)
        if (const auto dot = name.rfind(".R"); dot != std::string::npos && dot + 2 == name.size())
            layers.push_back(name.substr(0, dot));
    return layers;
}

}  // namespace

std::string clamped_text(std::uint64_t values) {
    return std::to_string(values) +
           " values above 65504, the largest that float16 holds, were written as 65504 (without --half they "
           "are kept)";
}

PictureFile read_picture(const std::string& path, const std::string& layer) {
    require_input(path);
    if (!is_exr(path)) {
        PictureFile picture{core::read_bitmap(path, false), {}, {}};
        if (!layer.empty()) throw InputError("only EXR files have layers", {path, 0});
        return picture;
    }
    const ImageChannels image = core::read_exr(path);
    PictureFile picture{{image.width, image.height, image.rgb(layer)},
                        layer.empty() ? variance_of_beauty(image) : image.rgb("Variance." + layer),
                        image.metadata};
    if (picture.bitmap.pixels.empty() && layer.empty())
        picture.bitmap = core::read_bitmap(path, false);  // grey, or with channels of other names
    if (picture.bitmap.pixels.empty())
        throw InputError(
            "there is no layer '" + core::printable(layer) + "'" + core::suggestion(layer, layers_of(image)),
            {path, 0});
    return picture;
}

}  // namespace mote::apps
