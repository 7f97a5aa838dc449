#include "apps/render_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/partial_render.h"
#include "apps/picture_file.h"
#include "core/film/film_image.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "session/denoise/denoised_layer.h"
#include "session/preview.h"

namespace mote::apps {

namespace fs = std::filesystem;

std::optional<core::PassRange> pass_range(const RenderArguments& arguments) {
    const std::string& text = arguments.pass_range;
    if (text.empty()) return std::nullopt;
    core::PassRange range;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, range.first);
    const bool colon = first.ec == std::errc() && first.ptr != end && *first.ptr == ':';
    const auto last = std::from_chars(colon ? first.ptr + 1 : end, end, range.end);
    if (last.ec != std::errc() || last.ptr != end || range.first >= range.end ||
        range.end > core::Film::max_passes)
        throw UsageError(fmt::format("--pass-range {}: expected A:B, passes A to B - 1, with A < B <= {}",
                                     core::printable(text), core::Film::max_passes));
    if (arguments.passes || arguments.seconds || arguments.noise || arguments.error)
        throw UsageError(
            "--pass-range says which passes are rendered: --passes, --time, --noise and --error do not go "
            "with it");
    return range;
}

RenderFiles render_files(const RenderArguments& arguments, const std::optional<core::PassRange>& range) {
    const bool named = !arguments.output.empty();
    std::string output = arguments.output;
    if (!named)
        output = fs::path(arguments.scene.scene)
                     .filename()
                     .replace_extension(range ? fmt::format(".{}-{}.film", range->first, range->end) : ".exr")
                     .string();
    const std::string extension = extension_of(output);
    if (range) {
        if (extension != ".film")
            throw UsageError("the output '" + core::printable(output) +
                             "' of --pass-range does not end in .film ('mote merge' makes the picture)");
        return {output, "", output + ".checkpoint", named, false};
    }
    if (extension != ".exr" && extension != ".png")
        throw UsageError("the output '" + core::printable(output) +
                         "' ends in neither .exr nor .png (the picture is written as EXR, with a PNG preview "
                         "beside it)");
    const bool names_preview = extension == ".png";
    const std::string exr = fs::path(output).replace_extension(names_preview ? ".exr" : extension).string();
    return {exr, names_preview ? output : fs::path(output).replace_extension(".png").string(),
            exr + ".checkpoint", named && !names_preview, named && names_preview};
}

void check_files(const RenderFiles& files, const RenderArguments& arguments,
                 std::span<const std::string> inputs) {
    const NamedFile outputs[] = {{"the picture", files.picture, files.named_picture},
                                 {"the preview", files.preview, files.named_preview},
                                 {"the statistics", arguments.stats},
                                 {"the checkpoint", files.checkpoint}};
    for (const NamedFile& output : outputs)
        if (!output.path.empty() && output.path != files.checkpoint) check_writable(output.path);
    check_outputs(outputs, scene_inputs(inputs));
}

std::string write_pictures(const RenderFiles& files, const Rendered& rendered,
                           const RenderArguments& arguments, bool half, std::vector<std::string>& warnings) {
    const core::ImageChannels& image = rendered.image;
    const std::uint64_t clamped = core::write_exr(files.picture, image, arguments.half || half);
    if (const std::uint64_t infinite = core::infinite_variances(image))
        warnings.push_back(
            fmt::format("the variance of {} pixels is too large for a float and written as infinity: lights "
                        "in larger units would keep it",
                        infinite));
    if (clamped > 0) warnings.push_back(clamped_text(clamped));
    return write_preview(files.preview,
                         image.metadata.contains(denoised_layer) ? denoised_picture(image) : image,
                         arguments.exposure, rendered.finished_pixels);
}

void write_range(const std::string& path, Rendered&& rendered, const RenderArguments& arguments,
                 const core::PassRange& range, const LoadedScene& scene) {
    MergedFilm partial{std::make_shared<core::Film>(std::move(*rendered.film)),
                       arguments,
                       scene.integrator().type(),
                       scene.scene_hash(),
                       rendered.counts,
                       range.first,
                       range.end};
    partial.render.scene.scene = fs::absolute(arguments.scene.scene).string();  // for merging it elsewhere
    write_partial(path, partial);
}

void write_statistics(const std::string& path, const Rendered& rendered, double write_seconds) {
    using nlohmann::json;
    json statistics = json::parse(rendered.statistics);
    auto warnings = statistics["warnings"].get<std::vector<std::string>>();
    for (const std::string& text : rendered.warnings)  // those of writing are not in it yet
        if (std::ranges::find(warnings, text) == warnings.end()) warnings.push_back(text);
    statistics["warnings"] = warnings;
    json& seconds = statistics["seconds"];
    seconds["write"] = write_seconds;
    seconds["total"] = seconds["total"].get<double>() + write_seconds;
    write_text(path, statistics.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace mote::apps
