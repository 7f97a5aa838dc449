// mote render: from a scene file to a layered EXR, a PNG preview and statistics. The steps; the render itself
// is session::render(), signals and progress are in command_observer.h, files in render_files.h.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "apps/command.h"
#include "apps/command_observer.h"
#include "apps/partial_render.h"
#include "apps/render_messages.h"
#include "apps/sequence.h"
#include "apps/subcommands.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "session/reference_metadata.h"
#include "session/usable_threads.h"

namespace mote::apps {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Threads of the whole process, from construction to destruction.
class Threads {
  public:
    explicit Threads(const RenderArguments& a)
        : wanted_(a.threads > 0 ? a.threads : tbb::info::default_concurrency()),
          count_(usable_threads(wanted_)),
          limit_(tbb::global_control::max_allowed_parallelism, std::size_t(count_)) {
        if (count_ < wanted_ && !a.quiet)
            note(fmt::format("warning: the system grants {} thread{} instead of {}", count_,
                             count_ == 1 ? "" : "s", wanted_));
    }
    int count() const { return count_; }

  private:
    int wanted_, count_;
    tbb::global_control limit_;
};

RenderSettings settings_of(const RenderArguments& a, const RenderFiles& files,
                           const std::optional<core::PassRange>& range, int threads) {
    RenderSettings s;
    s.seed = a.seed, s.stop = {a.passes, a.seconds, a.noise, a.error}, s.range = range, s.threads = threads;
    s.checkpoint = files.checkpoint, s.checkpoint_every = a.checkpoint_every, s.resume = a.resume;
    s.auxiliary = a.auxiliary, s.denoise = a.denoise, s.command_line = a.command_line;
    if (a.merged) s.begin_with = {a.merged->film, a.merged->statistics, a.merged->content_hash};
    if (a.sequence && a.auxiliary) s.frame_before = frame_before(*a.sequence);
    return s;
}

void warn_before(const RenderArguments& a, const LoadedScene& scene, const RenderFiles& files) {
    if (a.quiet) return;
    warn_about(scene);
    const core::Plan plan = scene.plan();
    for (const std::string& line : plan.warnings()) note(line);
    if (!a.resume && std::filesystem::exists(files.checkpoint))
        note(fmt::format("'{}' of an interrupted render is not used (--resume would continue it)",
                         core::printable(files.checkpoint)));
    if (a.verbose) std::fputs(plan.to_text().c_str(), stderr);
}

/// Writes what there is of the picture and its statistics.
void write_outputs(const RenderArguments& a, const RenderFiles& files,
                   const std::optional<core::PassRange>& range, const LoadedScene& scene,
                   Rendered& rendered) {
    const Clock::time_point start = Clock::now();
    if (range && !rendered.interrupted) write_range(files.picture, std::move(rendered), a, *range, scene);
    if (!range) {
        if (a.sequence)
            rendered.image.metadata[scene_files_key] = as_lines(scene.scene().parts().input_files);
        const std::string exposure = core::with_memory_for("writing the picture", [&] {
            return write_pictures(files, rendered, a, scene.scene().film().half, rendered.warnings);
        });
        if (!a.quiet)
            note(fmt::format("{}: exposure {}{}", core::printable(files.preview), exposure,
                             a.exposure ? "" : " (--exposure fixes it)"));
    }
    rendered.counts.seconds["write"] = seconds_since(start);
    if (!a.stats.empty()) write_statistics(a.stats, rendered, rendered.counts.seconds["write"]);
}

/// To make and compress the picture, about [s].
double seconds_to_write(const LoadedScene& scene) {
    constexpr double of_value = 70e-9;  ///< measured at 960 x 600 on two cores
    const core::FilmSettings& film = scene.scene().film();
    const auto layers = scene.integrator().layers(scene.scene()).size() + 2;  // with the sum and its variance
    return of_value * 3.0 * double(layers) * double(film.width) * double(film.height);
}

/// Writes the outputs and reports them. Returns the exit code.
int finish(const RenderArguments& a, const RenderFiles& files, const std::optional<core::PassRange>& range,
           const LoadedScene& scene, Rendered& rendered, Interruption& interruption) {
    if (waits_for_reader(files)) {  // perhaps forever
        interruption.end_at_once_while("writing into a pipe", "its reader lacks a part");
        if (rendered.interrupted) {
            note("interrupted: nothing is written into a pipe");
            return 128 + interruption.signal_number();
        }
    }
    interruption.writing_begins();
    if (rendered.film || !rendered.image.names.empty()) write_outputs(a, files, range, scene, rendered);
    report_render(a, rendered);
    if (rendered.interrupted) return report_interruption(a, files, rendered, interruption.signal_number());
    if (!rendered.finished_pixels.empty())
        note("--time is over in the first pass: " + finished_text(files, rendered));
    if (!a.quiet)
        std::fputs(fmt::format("{}\n{}{}", files.picture, files.preview, range ? "" : "\n").c_str(), stdout);
    return exit_ok;
}

}  // namespace

int render_command(const RenderArguments& arguments) {
    const Clock::time_point start = Clock::now();
    const std::optional<core::PassRange> range = pass_range(arguments);
    const RenderFiles files = render_files(arguments, range);
    Interruption interruption;
    interruption.end_at_once_while("loading the scene");
    if (arguments.seconds) interruption.set_alarm(*arguments.seconds + 2.0);
    const Threads threads(arguments);
    if (finished_before(arguments, files)) {
        if (!arguments.quiet) note(core::printable(files.picture) + " is finished");
        return exit_ok;
    }
    LoadedScene scene = load(arguments.scene, arguments.sequence ? arguments.sequence->registry : nullptr);
    RenderSettings settings = settings_of(arguments, files, range, threads.count());
    check_files(files, arguments, scene.scene().parts().input_files);
    if (arguments.identity) {
        std::fputs(identity_json(arguments, scene, render_hash(scene, settings)).c_str(), stdout);
        return exit_ok;
    }
    warn_before(arguments, scene, files);
    interruption.end_at_once_while("building");
    CommandObserver observer(arguments, files, scene, threads.count(), interruption);
    observer.show_coarse(settings);
    settings.seconds_before = seconds_since(start);
    if (arguments.seconds) settings.seconds_after = seconds_to_write(scene);
    Rendered rendered = session::render(scene, settings, observer);
    observer.end(rendered);
    const int code = finish(arguments, files, range, scene, rendered, interruption);
    if (code == exit_ok && arguments.sequence) arguments.sequence->rendered = std::move(scene);
    return code;
}

}  // namespace mote::apps
