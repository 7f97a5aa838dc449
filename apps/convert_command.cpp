// mote convert: pictures to EXR or PNG, glTF and pbrt scenes to XML (convert_scene.cpp), sequences to films
// (convert_sequence.cpp).
#include <cmath>
#include <cstdio>

#include "apps/command.h"
#include "apps/frame_files.h"
#include "apps/picture_file.h"
#include "apps/subcommands.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/converted_scenes.h"
#include "core/objects/error.h"
#include "session/output_files.h"

namespace mote::apps {

using core::Bitmap;
using core::ImageChannels;

int convert_command(const ConvertArguments& arguments) {
    const std::string kind = extension_of(arguments.output);
    if (kind == ".xml" || core::is_foreign_scene(arguments.input)) return convert_scene(arguments);
    if (arguments.lenient || !arguments.defines.empty())
        throw UsageError("--lenient and -D are for scenes, not for pictures");
    if (is_film(kind) && names_frames(arguments.input)) return convert_sequence(arguments);
    if (kind != ".exr" && kind != ".png")
        throw UsageError(
            "'" + core::printable(arguments.output) +
            "' ends in neither .exr nor .png (nor, for a glTF or pbrt scene, .xml; for frames/####.exr, "
            ".mp4, .webm, .mov or .gif)");
    if (kind == ".exr" && arguments.tone != core::linear_tone)
        throw UsageError("--tone is for PNG files and films; an EXR keeps radiance");
    check_outputs(std::vector<NamedFile>{{"the result", arguments.output}},
                  std::vector<NamedFile>{{"the picture that is converted,", arguments.input}});
    const Bitmap bitmap = read_picture(arguments.input, arguments.layer).bitmap;
    if (kind == ".png") {
        std::vector<core::Rgb> shown = bitmap.pixels;
        for (core::Rgb& p : shown) p = core::toned(arguments.tone, p * std::exp2(arguments.exposure));
        core::write_png(arguments.output, bitmap.width, bitmap.height, shown);
        return exit_ok;
    }
    ImageChannels image;
    image.width = bitmap.width, image.height = bitmap.height;
    std::vector<core::Rgb> pixels = bitmap.pixels;
    for (core::Rgb& p : pixels) p *= std::exp2(arguments.exposure);
    image.add_rgb("", pixels);
    if (const std::uint64_t clamped = core::write_exr(arguments.output, image, arguments.half))
        std::fputs(("mote: warning: " + clamped_text(clamped) + "\n").c_str(), stderr);
    return exit_ok;
}

}  // namespace mote::apps
