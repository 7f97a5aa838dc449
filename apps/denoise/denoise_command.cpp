// mote denoise: a picture and, beside its layers, what a denoiser makes of them; or a sequence of pictures.
#include "apps/denoise/denoise_command.h"

#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "apps/command.h"
#include "apps/frame_files.h"
#include "apps/options.h"
#include "apps/picture_file.h"
#include "apps/subcommands.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "session/denoise/denoised_layer.h"
#include "session/output_files.h"
#include "session/preview.h"

namespace mote::apps {

namespace {

namespace fs = std::filesystem;

std::string output_of(const DenoiseArguments& a) {
    if (a.output.empty()) return fs::path(a.input).stem().string() + "_denoised.exr";
    if (extension_of(a.output) != ".exr")
        throw UsageError(
            "the output '" + core::printable(a.output) +
            "' does not end in .exr (a PNG preview of the denoised picture is written beside it)");
    if (names_frames(a.input) && !names_frames(a.output))
        throw UsageError("the output '" + core::printable(a.output) +
                         "' has no #### for the number of the frame, as the input has");
    return a.output;
}

/// Input and output: one picture, or the frames of a sequence in order.
struct Work {
    std::string input, output;
    std::string preview() const { return fs::path(output).replace_extension(".png").string(); }
};

std::vector<Work> work_of(const DenoiseArguments& a) {
    const std::string output = output_of(a);
    if (!names_frames(a.input)) return {{a.input, output}};
    std::vector<Work> work;
    for (const FrameFile& frame : find_frames(a.input))
        work.push_back({frame.path, frame_name(output, frame.number)});
    return work;
}

void write_denoised(const Work& work, core::ImageChannels& image, const DenoiseArguments& a) {
    for (const char* written_anyway : {"pixelAspectRatio", "screenWindowWidth"})
        image.metadata.erase(written_anyway);
    if (const std::uint64_t clamped = core::write_exr(work.output, image, a.half))
        std::fputs(("mote: warning: " + clamped_text(clamped) + "\n").c_str(), stderr);
    write_preview(work.preview(), denoised_picture(image), a.exposure);
    if (a.quiet) return;
    std::fputs(("mote: " + image.metadata.at(denoised_layer) + "\n").c_str(), stderr);
    std::fputs((work.output + "\n" + work.preview() + "\n").c_str(), stdout);
}

int denoise_command(const DenoiseArguments& a) {
    const std::vector<Work> all = work_of(a);
    std::vector<NamedFile> outputs, inputs;
    for (const Work& work : all) {
        outputs.push_back({"the picture", work.output, !a.output.empty()});
        outputs.push_back({"the preview", work.preview(), false});
        inputs.push_back({"the picture to denoise", work.input});
    }
    check_outputs(outputs, inputs);
    for (const Work& work : all) require_input(work.input);
    std::optional<tbb::global_control> threads;
    if (a.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(a.threads));
    Denoiser denoise;
    for (const Work& work : all) {
        core::ImageChannels image = core::read_exr(work.input);
        if (!denoise) denoise = make_denoiser(a.method, a.threads, names_frames(a.input));
        try {
            denoise(image);
        } catch (const core::InputError& error) {
            throw core::InputError(error.what(), {work.input, 0});
        }
        write_denoised(work, image, a);
    }
    return exit_ok;
}

}  // namespace

void add_denoise(CLI::App& app, DenoiseArguments& a, std::function<int()>& action) {
    CLI::App& command = *app.add_subcommand(
        "denoise", "Add a denoised picture, for the eye, to an EXR or to each of a sequence");
    command
        .add_option("IN", a.input,
                    "An EXR, best one rendered with --denoise or --auxiliary; a.####.exr: a sequence")
        ->required();
    command.add_option("OUT,-o,--output", a.output,
                       "The EXR file to write, with a PNG beside it (default: IN_denoised.exr)");
    command
        .add_option("--method", a.method,
                    "oidn: OpenImageDenoise, where it is installed (default); bmfr: regression on features "
                    "block by block, with the frames before in sequences")
        ->check(CLI::IsMember({"oidn", "bmfr"}));
    add_exposure(command, a.exposure);
    add_threads(command, a.threads);
    add_half(command, a.half);
    command.add_flag("--quiet", a.quiet, "Say nothing");
    command.callback([&a, &action] { action = [&a] { return denoise_command(a); }; });
}

}  // namespace mote::apps
