// mote convert SCENE.gltf SCENE.xml (or SCENE.pbrt): the scene in our language, and a folder with its meshes
// and pictures.
#include <cstdio>
#include <filesystem>

#include "apps/command.h"
#include "apps/picture_file.h"
#include "apps/subcommands.h"
#include "core/formats/conversion/scratch_folder.h"
#include "core/formats/xml/converted_scenes.h"
#include "session/output_files.h"

namespace mote::apps {

namespace fs = std::filesystem;

namespace {

/// Throws InputError where the scene was read from one of the files that would be written.
void move_files(const fs::path& from, const fs::path& to, const std::vector<std::string>& inputs,
                const std::string& scene) {
    std::vector<NamedFile> outputs = {{"the scene", scene}};
    for (const auto& file : fs::directory_iterator(from))
        outputs.push_back({"a file of the scene", (to / file.path().filename()).string()});
    check_outputs(outputs, scene_inputs(inputs));
    check_companions(std::span(outputs).subspan(1), scene);
    std::error_code error;
    fs::create_directories(to, error);
    for (const auto& file : fs::directory_iterator(from))
        if (!error)
            fs::copy_file(file.path(), to / file.path().filename(), fs::copy_options::overwrite_existing,
                          error);
    if (error) throw core::InputError("cannot be written: " + error.message(), {to.string(), 0});
}

}  // namespace

int convert_scene(const ConvertArguments& arguments) {
    if (!core::is_foreign_scene(arguments.input) || extension_of(arguments.output) != ".xml")
        throw UsageError("a scene is converted from .gltf, .glb or .pbrt to .xml, not from '" +
                         core::printable(arguments.input) + "' to '" + core::printable(arguments.output) +
                         "'");
    if (arguments.half || arguments.exposure != 0.0f || arguments.tone != core::linear_tone ||
        !arguments.layer.empty())
        throw UsageError("--half, --exposure, --tone and --layer are for pictures, not for scenes");
    require_input(arguments.input);
    auto defines = split_defines(arguments.defines);
    core::ConversionOptions options = core::take_conversion_options(arguments.input, defines);
    if (!defines.empty())
        throw UsageError("-D " + core::printable(defines.front().first) +
                         ": a conversion of glTF takes camera=NAME and emission=FACTOR, one of pbrt nothing");
    const fs::path folder = fs::path(arguments.output).replace_extension().string() + "_files";
    options.prefix = folder.filename().string() + "/", options.copy_files = true;
    const core::ScratchFolder scratch;  // nothing is left of a scene that is refused
    const core::ConvertedScene scene = core::convert_foreign_scene(arguments.input, scratch.path(), options);
    for (const std::string& line : core::approximations_of(scene, arguments.lenient))
        std::fputs(("mote: --lenient: " + line + "\n").c_str(), stderr);
    for (const std::string& note : scene.report.notes)
        std::fputs(("mote: warning: " + arguments.input + ": " + note + "\n").c_str(), stderr);
    move_files(scratch.path(), folder, scene.files, arguments.output);
    write_text(arguments.output, scene.xml);
    std::printf("%s\n%s\n", arguments.output.c_str(), folder.string().c_str());
    return exit_ok;
}

}  // namespace mote::apps
