// mote render: from a scene file to a layered EXR, a PNG preview and statistics. Options, signals and files;
// the render itself is session::render().
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "apps/command.h"
#include "apps/interruption.h"
#include "apps/partial_render.h"
#include "apps/progress_line.h"
#include "apps/render_files.h"
#include "apps/render_messages.h"
#include "apps/sequence.h"
#include "apps/subcommands.h"
#include "apps/tev_viewer.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "session/preview.h"
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

/// True where an output is a pipe, which waits for its reader.
bool waits_for_reader(const RenderFiles& files) {
    std::error_code ignored;
    return std::filesystem::is_fifo(files.picture, ignored) ||
           std::filesystem::is_fifo(files.preview, ignored);
}

/// Progress, signals, preview and viewer.
class CommandObserver : public RenderObserver {
  public:
    CommandObserver(const RenderArguments& arguments, const RenderFiles& files, const LoadedScene& scene,
                    int threads, Interruption& interruption)
        : arguments_(arguments),
          preview_file_(waits_for_reader(files) ? "" : files.preview),
          interruption_(interruption),
          line_(fmt::format("mote: {}: {}, {} x {} pixels, {} thread{}", scene.scene().parts().file,
                            scene.integrator().type(), scene.scene().film().width,
                            scene.scene().film().height, threads, threads == 1 ? "" : "s"),
                arguments.quiet) {
        if (!arguments.tev.empty())
            viewer_.emplace(arguments.tev, files.picture, scene.scene().film().width,
                            scene.scene().film().height);
    }
    ~CommandObserver() override { line_.end(); }

    void progress(const core::RenderProgress& p) override { line_.update(p); }
    bool cancelled() override { return interruption_.signal_number() != 0; }
    bool wants_previews() const override { return !preview_file_.empty() || viewer_; }
    void preview(const core::ImageChannels& image) override {
        if (!preview_file_.empty()) write_preview(preview_file_, image, arguments_.exposure);
        show(image.rgb(""));
    }
    void warning(const std::string& text) override {
        if (!arguments_.quiet) note("warning: " + text);
    }
    void building_is_over() override {
        interruption_.set_alarm(std::nullopt);
        interruption_.end_at_once_while(nullptr);
    }
    /// The last line of progress ends, and the viewer gets the picture of the end.
    void end(const Rendered& rendered) {
        line_.end();
        show(rendered.film ? rendered.film->beauty() : rendered.image.rgb(""));
    }

  private:
    void show(std::vector<core::Rgb> picture) {
        if (viewer_ && !picture.empty()) viewer_->show(std::move(picture));
    }
    const RenderArguments& arguments_;
    const std::string preview_file_;
    Interruption& interruption_;
    ProgressLine line_;
    std::optional<TevViewer> viewer_;
};

RenderSettings settings_of(const RenderArguments& a, const RenderFiles& files,
                           const std::optional<core::PassRange>& range, int threads) {
    RenderSettings s;
    s.seed = a.seed, s.stop = {a.passes, a.seconds, a.noise}, s.range = range, s.threads = threads;
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
    settings.seconds_before = seconds_since(start);
    Rendered rendered = session::render(scene, settings, observer);
    observer.end(rendered);
    if (waits_for_reader(files)) {  // perhaps forever
        interruption.end_at_once_while("writing into a pipe", "its reader lacks a part");
        if (rendered.interrupted) {
            note("interrupted: nothing is written into a pipe");
            return 128 + interruption.signal_number();
        }
    }
    if (rendered.film || !rendered.image.names.empty())
        write_outputs(arguments, files, range, scene, rendered);
    report_render(arguments, rendered);
    if (rendered.interrupted)
        return report_interruption(arguments, files, rendered, interruption.signal_number());
    if (!rendered.finished_pixels.empty())
        note("--time is over in the first pass: " + finished_text(files, rendered));
    if (!arguments.quiet)
        std::fputs(fmt::format("{}\n{}{}", files.picture, files.preview, range ? "" : "\n").c_str(), stdout);
    if (arguments.sequence) arguments.sequence->rendered = std::move(scene);
    return exit_ok;
}

}  // namespace mote::apps
