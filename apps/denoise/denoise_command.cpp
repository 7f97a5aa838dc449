// mote denoise: a picture and, beside its layers, what OpenImageDenoise makes of them.
#include "apps/denoise/denoise_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "apps/command.h"
#include "apps/denoise/denoised_layer.h"
#include "apps/number_options.h"
#include "apps/output_files.h"
#include "apps/picture_file.h"
#include "apps/preview.h"
#include "apps/subcommands.h"
#include "core/objects/error.h"

namespace mote::apps {

namespace {

namespace fs = std::filesystem;

std::string output_of(const DenoiseArguments& a) {
    if (a.output.empty()) return fs::path(a.input).stem().string() + "_denoised.exr";
    if (extension_of(a.output) != ".exr")
        throw UsageError(
            "the output '" + core::printable(a.output) +
            "' does not end in .exr (a PNG preview of the denoised picture is written beside it)");
    return a.output;
}

int denoise_command(const DenoiseArguments& a) {
    const std::string output = output_of(a), preview = fs::path(output).replace_extension(".png").string();
    check_outputs(std::vector<NamedFile>{{"the picture", output}, {"the preview", preview}},
                  std::vector<NamedFile>{{"the picture to denoise", a.input}});
    require_input(a.input);
    core::ImageChannels image = core::read_exr(a.input);
    const OidnLibrary library(a.threads);
    try {
        add_denoised_layer(image, library);
    } catch (const core::InputError& error) {
        throw core::InputError(error.what(), {a.input, 0});
    }
    for (const char* written_anyway : {"pixelAspectRatio", "screenWindowWidth"})
        image.metadata.erase(written_anyway);
    if (const std::uint64_t clamped = core::write_exr(output, image, a.half))
        std::fputs(("mote: warning: " + clamped_text(clamped) + "\n").c_str(), stderr);
    write_preview(preview, denoised_picture(image), a.exposure);
    if (!a.quiet) {
        std::fputs(("mote: " + image.metadata.at(denoised_layer) + "\n").c_str(), stderr);
        std::fputs((output + "\n" + preview + "\n").c_str(), stdout);
    }
    return exit_ok;
}

}  // namespace

void add_denoise(CLI::App& app, DenoiseArguments& a, std::function<int()>& action) {
    CLI::App& command = *app.add_subcommand(
        "denoise", "Add a denoised picture, for the eye, to an EXR (needs OpenImageDenoise)");
    command.add_option("IN", a.input, "An EXR, best one rendered with --denoise or --auxiliary")->required();
    command.add_option("-o,--output", a.output,
                       "The EXR file to write, with a PNG beside it (default: IN_denoised.exr)");
    command
        .add_option("--exposure", a.exposure, "Brighten the preview by this many stops (default: it adapts)")
        ->check(number_between(-100.0, 100.0));
    command.add_option("-t,--threads", a.threads, "Number of threads (default: one for every core)")
        ->check(whole_number(0, 4096));
    command.add_flag("--half", a.half, "Write float16 instead of float32");
    command.add_flag("--quiet", a.quiet, "Say nothing");
    command.callback([&a, &action] { action = [&a] { return denoise_command(a); }; });
}

}  // namespace mote::apps
