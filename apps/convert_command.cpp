// mote convert: pictures to EXR or PNG.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/command.h"
#include "apps/subcommands.h"
#include "core/image/image_file.h"
#include "core/scene/error.h"

namespace mote::apps {

namespace {

using core::Bitmap;
using core::ImageChannels;

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return extension;
}

Bitmap read_layer(const ConvertArguments& arguments) {
    if (arguments.layer.empty()) return core::read_bitmap(arguments.input, false);
    const ImageChannels image = core::read_exr(arguments.input);
    Bitmap bitmap{image.width, image.height, image.rgb(arguments.layer)};
    if (!bitmap.pixels.empty()) return bitmap;
    std::vector<std::string> layers;
    for (const std::string& name : image.names)
        if (const auto dot = name.rfind(".R"); dot != std::string::npos && dot + 2 == name.size())
            layers.push_back(name.substr(0, dot));
    throw core::InputError("there is no layer '" + core::printable(arguments.layer) + "'" +
                               core::suggestion(arguments.layer, layers),
                           {arguments.input, 0});
}

}  // namespace

int convert_command(const ConvertArguments& arguments) {
    const std::string kind = extension_of(arguments.output);
    if (kind != ".exr" && kind != ".png")
        throw UsageError("'" + core::printable(arguments.output) + "' ends in neither .exr nor .png");
    const Bitmap bitmap = read_layer(arguments);
    if (kind == ".png") {
        core::write_png(arguments.output, bitmap.width, bitmap.height, bitmap.pixels, arguments.exposure);
        return exit_ok;
    }
    ImageChannels image;
    image.width = bitmap.width, image.height = bitmap.height;
    std::vector<core::Rgb> pixels = bitmap.pixels;
    for (core::Rgb& p : pixels) p *= std::exp2(arguments.exposure);
    image.add_rgb("", pixels);
    core::write_exr(arguments.output, image, arguments.half);
    return exit_ok;
}

}  // namespace mote::apps
