// mote render: from a scene file to a layered EXR, a PNG preview and statistics.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iterator>
#include <optional>

#include "apps/command.h"
#include "apps/interruption.h"
#include "apps/output_files.h"
#include "apps/partial_render.h"
#include "apps/picture_file.h"
#include "apps/preview.h"
#include "apps/progress_line.h"
#include "apps/subcommands.h"
#include "apps/tev_viewer.h"
#include "core/files/atomic_file.h"
#include "core/film/film_image.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "core/render/render_driver.h"
#include "core/render/stop_clock.h"
#include "session/auxiliary_channels.h"
#include "session/denoise/bmfr_sequence.h"
#include "session/denoise/denoised_layer.h"
#include "session/in_scattered_feature.h"
#include "session/reference_metadata.h"
#include "session/render_report.h"
#include "session/usable_threads.h"

namespace mote::apps {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void note(const std::string& text) { std::fputs(fmt::format("mote: {}\n", text).c_str(), stderr); }

/// `picture` is a partial film where a range of passes is asked for; it has no preview then.
struct OutputFiles {
    std::string picture, preview, checkpoint;
};

std::optional<core::PassRange> pass_range(const RenderArguments& arguments) {
    const std::string& text = arguments.pass_range;
    if (text.empty()) return std::nullopt;
    core::PassRange range;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, range.first);
    const bool colon = first.ec == std::errc() && first.ptr != end && *first.ptr == ':';
    const auto last = std::from_chars(colon ? first.ptr + 1 : end, end, range.end);
    if (last.ec != std::errc() || last.ptr != end || range.first >= range.end ||
        range.end > core::Film::most_passes)
        throw UsageError(fmt::format("--pass-range {}: expected A:B, passes A to B - 1, with A < B <= {}",
                                     core::printable(text), core::Film::most_passes));
    if (arguments.passes || arguments.seconds || arguments.noise)
        throw UsageError(
            "--pass-range says which passes are rendered: --passes, --time and --noise do not go with it");
    return range;
}

OutputFiles output_files(const RenderArguments& arguments, const std::optional<core::PassRange>& range) {
    if (range) {
        std::string film = arguments.output;
        if (film.empty())
            film = fs::path(arguments.scene.scene)
                       .filename()
                       .replace_extension(fmt::format(".{}-{}.film", range->first, range->end))
                       .string();
        if (extension_of(film) != ".film")
            throw UsageError("the output '" + core::printable(film) +
                             "' of --pass-range does not end in .film ('mote merge' makes the picture)");
        return {film, "", film + ".checkpoint"};
    }
    std::string picture = arguments.output;
    if (picture.empty())
        picture = fs::path(arguments.scene.scene).filename().replace_extension(".exr").string();
    const std::string extension = extension_of(picture);
    if (extension != ".exr" && extension != ".png")
        throw UsageError("the output '" + core::printable(picture) +
                         "' ends in neither .exr nor .png (the picture is written as EXR, with a PNG preview "
                         "beside it)");
    if (extension == ".png") {  // whoever names the preview gets it, and the picture beside it
        const std::string exr = fs::path(picture).replace_extension(".exr").string();
        return {exr, picture, exr + ".checkpoint"};
    }
    return {picture, fs::path(picture).replace_extension(".png").string(), picture + ".checkpoint"};
}

void check_identities(const OutputFiles& files, const RenderArguments& arguments, const core::Scene& scene) {
    const NamedFile outputs[] = {{"the picture", files.picture},
                                 {"the preview", files.preview},
                                 {"the statistics", arguments.stats},
                                 {"the checkpoint", files.checkpoint}};
    check_outputs(outputs, scene_inputs(scene.parts().input_files));
}

// Hours of rendering must not end with the discovery that the folder does not exist.
void check_writable(const std::string& path) {
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
        throw core::InputError("cannot be written: there is no folder '" + folder.string() + "'", {path, 0});
    if (fs::is_directory(path, ignored))
        throw core::InputError("cannot be written: it is a folder", {path, 0});
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw core::InputError(std::string("cannot be written: ") + std::strerror(errno), {path, 0});
}

void warn_about(const core::Scene& scene, const core::LoadReport& loaded, const core::Plan& plan) {
    warn_about_scene(scene, loaded);
    for (const std::string& line : plan.warnings()) note(line);
}

// What changes the picture besides the contents of files.
std::vector<std::string> settings_of(const RenderArguments& render, const std::string& integrator) {
    std::vector<std::string> settings = render_settings(scene_changes(render.scene), integrator);
    if (wants_motion(render) && render.sequence->previous) {
        settings.emplace_back("the frame before");
        const auto& before = render.sequence->previous->defines;
        settings.insert(settings.end(), before.begin(), before.end());
    }
    return settings;
}

/// Of a sequence: was this very frame finished before? Asked of its header and of the files that its scene
/// was read from, before the scene is loaded: if none has changed, no other belongs to it.
bool finished_before(const OutputFiles& files, const RenderArguments& arguments) {
    std::error_code ignored;
    if (!arguments.sequence || !arguments.resume || fs::exists(files.checkpoint, ignored) ||
        !fs::exists(files.picture, ignored))
        return false;
    try {
        const auto metadata = core::read_exr_metadata(files.picture);
        const auto entry = [&](const char* key) {
            const auto it = metadata.find(key);
            return it != metadata.end() ? it->second : std::string();
        };
        const std::vector<std::string> inputs = lines_of(entry(scene_files_key));
        if (inputs.empty() || metadata.contains("partOfFirstPass")) return false;
        return entry("sceneHash") ==
                   core::content_hash(inputs, settings_of(arguments, entry("integrator"))) &&
               entry("seed") == std::to_string(arguments.seed) &&
               (!arguments.passes || entry("passes") == std::to_string(*arguments.passes));
    } catch (const core::InputError&) {
        return false;  // damaged, or a file is gone: it is made anew
    }
}

/// Where shapes and camera were in the frame before; nothing for the first of a sequence.
const core::PreviousFrame* frame_before(const RenderArguments& arguments, const core::Registry& registry) {
    if (!wants_motion(arguments) || !arguments.sequence->previous) return nullptr;
    SequenceFrame& sequence = *arguments.sequence;
    if (!sequence.before)
        sequence.before = std::make_unique<core::PreviousFrame>(load(*sequence.previous, registry));
    return sequence.before.get();
}

std::vector<core::HitFeature> features_of(const RenderArguments& arguments, const core::Scene& scene,
                                          const core::LoadReport& loaded, const core::PreviousFrame* before) {
    std::vector<core::HitFeature> features =
        wanted_features(scene, loaded.features, arguments.auxiliary, arguments.denoise);
    if (before && arguments.auxiliary)
        std::ranges::move(core::motion_features(scene, *before), std::back_inserter(features));
    return features;
}

// Values that are right and do not fit into the file.
void warn_of_range(const core::ImageChannels& image, std::uint64_t clamped,
                   std::vector<std::string>& warnings) {
    if (const std::uint64_t infinite = core::infinite_variances(image))
        warnings.push_back(
            fmt::format("the variance of {} pixels is too large for a float and written as "
                        "infinity: lights in larger units would keep it",
                        infinite));
    if (clamped > 0) warnings.push_back(clamped_text(clamped));
}

using Denoiser = std::function<void(core::ImageChannels&)>;  ///< adds the layer

/// Empty where none is asked for.
Denoiser denoiser_of(const RenderArguments& arguments, int threads) {
    if (arguments.denoise == "oidn")
        return [library = std::make_shared<OidnLibrary>(threads)](core::ImageChannels& image) {
            add_denoised_layer(image, *library);
        };
    // Frames of a sequence as well: each has the bits that it has alone.
    if (arguments.denoise == "bmfr")
        return [](core::ImageChannels& image) { BmfrSequence(true).add_denoised_layer(image); };
    return {};
}

/// Adds the denoised layer where there is a whole picture, and time: returns whether it did.
bool denoise(core::ImageChannels& image, const RenderArguments& arguments, const Denoiser& denoiser,
             const core::RenderResult& result, const std::string& file, std::vector<std::string>& warnings) {
    if (!denoiser) return false;
    if (!result.finished_pixels.empty() || !result.film.has_passes(1)) {
        note("a part of a picture is not denoised");
        return false;
    }
    if (result.interrupted) {
        note(fmt::format("not denoised: 'mote denoise {}{}' does it",
                         arguments.denoise == "bmfr" ? "--method bmfr " : "", core::printable(file, 300)));
        return false;
    }
    try {
        denoiser(image);
        return true;
    } catch (const core::InputError& error) {  // the picture is worth more
        warnings.push_back(std::string("not denoised: ") + error.what());
        return false;
    }
}

void write_outputs(const OutputFiles& files, const RenderReport& report, const RenderArguments& arguments,
                   const core::Registry& registry, const Denoiser& denoiser,
                   std::vector<std::string>& warnings) {
    core::ImageChannels image = make_picture(
        report, registry, {arguments.auxiliary, arguments.auxiliary || arguments.denoise == "bmfr"});
    if (arguments.sequence) image.metadata[scene_files_key] = as_lines(report.scene.parts().input_files);
    const std::span<const std::uint8_t> finished = report.result.finished_pixels;
    const bool denoised = denoise(image, arguments, denoiser, report.result, files.picture, warnings);
    const std::uint64_t clamped =
        core::write_exr(files.picture, image, arguments.half || report.scene.film().half);
    warn_of_range(image, clamped, warnings);
    const std::string exposure = write_preview(files.preview, denoised ? denoised_picture(image) : image,
                                               arguments.exposure, finished);
    if (!arguments.quiet)
        note(fmt::format("{}: exposure {}{}", core::printable(files.preview), exposure,
                         arguments.exposure ? "" : " (--exposure fixes it)"));
}

/// The passes of a range as a partial film. The scene has its whole name, for whoever merges it elsewhere.
void write_range(const std::string& path, const RenderArguments& arguments, const core::PassRange& range,
                 const RenderReport& report) {
    MergedFilm partial{
        report.result.film, arguments, report.plan.integrator, report.scene_hash, report.result.statistics,
        range.first,        range.end};
    partial.render.scene.scene = fs::absolute(arguments.scene.scene).string();
    write_partial(path, partial);
}

/// Films that are merged must be of this scene: it may have changed since.
void check_merged(const MergedFilm& merged, const core::RenderRequest& request) {
    if (merged.content_hash != request.content_hash)
        throw core::InputError(
            "the partial films are of another render: the scene, a file that it names, or the version "
            "of mote has changed since");
}

void print_times(const core::Statistics& statistics) {
    for (const auto& [name, seconds] : statistics.seconds)
        std::fputs(fmt::format("  {:12} {:9.3f} s\n", name, seconds).c_str(), stderr);
    std::fputs(fmt::format("  {:12} {:9.1f} MB\n", "peak memory", double(peak_memory_bytes()) * 1e-6).c_str(),
               stderr);
}

/// A second is not always enough for what comes after the last pass.
std::string unfinished_text(const core::RenderResult& result) {
    const std::uint32_t passes = *result.finished_for;
    return fmt::format(
        "filters or compensation of the whole picture take too long to wait for and are {}; with '--resume "
        "--passes {}' they are made now",
        passes > 0 ? fmt::format("those of the preview after pass {}", passes) : "left out",
        result.film.pass_count());
}

int report_interruption(const RenderArguments& arguments, const OutputFiles& files,
                        const core::RenderResult& result, int signal_number) {
    if (result.film.pass_count() == 0) {
        note("interrupted before the first pixel was complete: there is nothing to write");
    } else if (!result.finished_pixels.empty()) {
        note(
            fmt::format("interrupted in the first pass: {} holds {:.1f} % of its pixels, the others have "
                        "alpha 0; there is "
                        "nothing to resume",
                        files.picture, 100.0 * finished_share(result)));
    } else if (arguments.pass_range.empty() && !result.film.has_passes(1)) {
        std::string missing;
        for (const core::Layer& layer : result.film.layers())
            if (result.film.pass_count(layer.part) == 0)
                missing += (missing.empty() ? "" : ", ") + layer.name;
        note(fmt::format("interrupted before every layer had a pass: {} holds the picture without {}",
                         files.picture, missing));
    } else if (!result.checkpoint_problem.empty()) {
        note(fmt::format(
            "interrupted after {} passes: {} holds the picture so far, but it cannot be resumed ({})",
            result.film.pass_count(), files.picture, result.checkpoint_problem));
    } else {
        std::vector<std::string> command = arguments.command_line;
        if (!arguments.resume) command.emplace_back("--resume");
        if (arguments.pass_range.empty())
            note(fmt::format("interrupted after {} passes: {} holds the picture so far",
                             result.film.pass_count(), files.picture));
        else
            note(fmt::format("interrupted after {} passes of the range: {} is not written",
                             result.film.pass_count(), files.picture));
        note("continue with: " + quoted(command));
        if (result.finished_for) note(unfinished_text(result));
    }
    return 128 + signal_number;
}

}  // namespace

int render_command(const RenderArguments& arguments) {
    const std::optional<core::PassRange> range = pass_range(arguments);
    const OutputFiles files = output_files(arguments, range);
    const Clock::time_point start = Clock::now();
    Interruption interruption;
    interruption.end_at_once_while("loading the scene");
    if (arguments.seconds) interruption.set_alarm(*arguments.seconds + 2.0);
    const int wanted = arguments.threads > 0 ? arguments.threads : tbb::info::default_concurrency();
    const int threads = usable_threads(wanted);
    if (threads < wanted && !arguments.quiet)
        note(fmt::format("warning: the system grants {} thread{} instead of {}", threads,
                         threads == 1 ? "" : "s", wanted));
    const tbb::global_control thread_limit(tbb::global_control::max_allowed_parallelism,
                                           std::size_t(threads));

    if (finished_before(files, arguments)) {
        if (!arguments.quiet) note(core::printable(files.picture) + " is finished");
        return exit_ok;
    }

    std::optional<core::Registry> own;
    if (!arguments.sequence) own = make_registry();
    const core::Registry& registry = arguments.sequence ? arguments.sequence->registry : *own;
    core::LoadReport loaded;
    auto scene =
        core::with_memory_for("loading the scene", [&] { return load(arguments.scene, registry, &loaded); });
    const core::Integrator& integrator = require_integrator(*scene, registry);
    const core::Plan plan = integrator.plan(*scene, core::find_requirements(*scene));
    check_writable(files.picture);
    if (!range) check_writable(files.preview);
    if (!arguments.stats.empty()) check_writable(arguments.stats);
    check_identities(files, arguments, *scene);
    const Denoiser denoiser = denoiser_of(arguments, threads);  // what is missing is said now, not in hours

    const std::string content = core::content_hash(*scene, settings_of(arguments, integrator.type()));
    if (arguments.identity) {
        std::fputs(identity_json(arguments, *scene, integrator, content).c_str(), stdout);
        return exit_ok;
    }
    core::RenderRequest request;
    request.seed = arguments.seed;
    request.stop = {arguments.passes, arguments.seconds, arguments.noise};
    request.range = range;
    request.checkpoint_path = files.checkpoint;
    request.checkpoint_every_seconds = arguments.checkpoint_every;
    request.checkpoint_at_end = false;
    request.resume = arguments.resume;
    request.content_hash = content;
    request.features = features_of(arguments, *scene, loaded, frame_before(arguments, registry));
    if (arguments.merged) check_merged(*arguments.merged, request);
    if (arguments.merged) request.begin_with = &arguments.merged->film;
    const double load_seconds = seconds_since(start);
    interruption.end_at_once_while("building");

    if (!arguments.quiet) {
        warn_about(*scene, loaded, plan);
        if (!arguments.resume && fs::exists(files.checkpoint))
            note(fmt::format("'{}' of an interrupted render is not used (--resume would continue it)",
                             core::printable(files.checkpoint)));
        if (arguments.verbose) std::fputs(plan.to_text().c_str(), stderr);
    }

    ProgressLine progress(
        fmt::format("mote: {}: {}, {} x {} pixels, {} thread{}", scene->parts().file, plan.integrator,
                    scene->film().width, scene->film().height, threads, threads == 1 ? "" : "s"),
        arguments.quiet);
    request.interrupted = &interruption.flag(), request.time_is_over = &interruption.time_is_over();
    request.seconds_before = load_seconds;
    request.keep_part_of_first_pass = !range;
    request.building_is_over = [&] {
        // A pass may end a second late (stop_clock.h); what takes longer is cut off.
        if (arguments.seconds)
            interruption.set_alarm(
                std::max(0.5, *arguments.seconds + core::most_seconds_late - seconds_since(start)));
        interruption.end_at_once_while(nullptr);
    };
    request.passes_are_over = [&] { interruption.forget_time(); };
    std::optional<TevViewer> viewer;
    if (!arguments.tev.empty())
        viewer.emplace(arguments.tev, files.picture, scene->film().width, scene->film().height);
    if (!range || viewer)
        request.preview = [&](const core::Film& film) {
            std::vector<core::Rgb> picture = film.beauty();
            if (!range) {
                core::ImageChannels image;
                image.width = film.width(), image.height = film.height();
                image.add_rgb("", picture);
                write_preview(files.preview, image, arguments.exposure);
            }
            if (viewer) viewer->show(std::move(picture));
        };
    request.checkpoint_failed = [&](const std::string& why) {
        if (!arguments.quiet) note("warning: " + why + "; it is tried again");
    };
    request.progress = [&progress](const core::RenderProgress& p) { progress.update(p); };
    core::RenderResult result = [&] {
        try {
            return core::render(*scene, integrator, request);
        } catch (...) {
            progress.end();
            throw;
        }
    }();
    progress.end();
    result.statistics.seconds["load"] = load_seconds;
    if (viewer) viewer->show(result.film.beauty());
    if (arguments.merged) add_statistics(result.statistics, arguments.merged->statistics);

    if (result.film.pass_count() == 0 && !result.interrupted)
        throw core::InputError("--time is over before the first pixel was complete: there is no picture");
    if (result.film.pass_count() > 0) {
        const Clock::time_point write_start = Clock::now();
        RenderReport report{*scene,
                            plan,
                            result,
                            request.content_hash,
                            scene_content(*scene, arguments.scene.defines),
                            arguments.seed,
                            threads,
                            arguments.command_line,
                            loaded.approximations};
        core::with_memory_for("writing the picture", [&] {
            if (!range)
                write_outputs(files, report, arguments, registry, denoiser, result.statistics.warnings);
            else if (!result.interrupted)
                write_range(files.picture, arguments, *range, report);
        });
        result.statistics.seconds["write"] = seconds_since(write_start);
        if (!arguments.stats.empty()) {
            const std::string json = statistics_json(report);
            core::write_file_atomically(arguments.stats, std::as_bytes(std::span(json.data(), json.size())));
        }
    }
    if (!arguments.quiet) {
        for (const std::string& warning : result.statistics.warnings) note("warning: " + warning);
        if (arguments.verbose) print_times(result.statistics);
    }
    if (result.statistics.non_finite_samples > 0)  // a defect of ours: said even when asked to be quiet
        note(
            fmt::format("WARNING: {} pixel samples were NaN or infinite and count as black; please report "
                        "this scene",
                        result.statistics.non_finite_samples));
    if (!result.interrupted && !result.finished_pixels.empty())
        note(fmt::format(
            "--time is over in the first pass: {} holds {:.1f} % of its pixels, the others have alpha 0",
            files.picture, 100.0 * finished_share(result)));
    if (result.interrupted)
        return report_interruption(arguments, files, result, interruption.signal_number());

    std::error_code ignored;
    fs::remove(files.checkpoint, ignored);  // there may be none
    if (!arguments.quiet)
        std::fputs(fmt::format("{}\n{}{}", files.picture, files.preview, range ? "" : "\n").c_str(), stdout);
    if (arguments.sequence) arguments.sequence->rendered = std::move(scene);
    return exit_ok;
}

}  // namespace mote::apps
