#include "session/render.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <iterator>

#include "core/film/film_image.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "core/render/checkpoint.h"
#include "core/render/cpu_clock.h"
#include "core/render/stop_clock.h"
#include "session/add_statistics.h"
#include "session/auxiliary_channels.h"
#include "session/borrowed_arena.h"
#include "session/denoise/denoised_layer.h"
#include "session/render_report.h"
#include "session/usable_threads.h"
#include "session/watched_work.h"

namespace mote::session {

namespace {

std::vector<core::HitFeature> features_of(const LoadedScene& scene, const RenderSettings& settings) {
    std::vector<core::HitFeature> features =
        wanted_features(scene.scene(), scene.report().features, settings.auxiliary, settings.denoise);
    if (settings.frame_before && settings.auxiliary)
        std::ranges::move(core::motion_features(scene.scene(), *settings.frame_before->frame),
                          std::back_inserter(features));
    return features;
}

core::ImageChannels preview_of(const core::Film& film, const std::optional<core::PictureError>& error,
                               bool with_layers) {
    core::ImageChannels image;
    if (with_layers) {
        image = core::film_image(film);
        image.metadata["passes"] = std::to_string(film.has_passes(1) ? film.pass_count() : 0);
        image.metadata["noise"] = fmt::format("{:.6g}", film.noise());
        add_error(image.metadata, error);
        return image;
    }
    image.width = film.width(), image.height = film.height();
    image.add_rgb("", film.beauty());
    return image;
}

/// One render in its own thread.
class RenderWork {
  public:
    RenderWork(const LoadedScene& scene, const RenderSettings& settings, WatchedWork& watched,
               bool wants_previews)
        : scene_(scene),
          settings_(settings),
          watched_(watched),
          wants_previews_(wants_previews),
          threads_(
              usable_threads(settings.threads > 0 ? settings.threads : tbb::info::default_concurrency())),
          denoiser_(settings.denoise.empty()
                        ? Denoiser()
                        : make_denoiser(settings.denoise, threads_, false, settings.oidn_package)),
          plan_(scene.plan()),
          hash_(render_hash(scene, settings)) {
        if (settings.stop.noise && !settings.stop.passes && !settings.stop.seconds &&
            !plan_.noise_unknown.empty())
            throw core::InputError(
                "the noise of this image is not known, and a limit on it would not end the render: " +
                plan_.noise_unknown + "; give a number of passes or a time");
        if (settings.stop.error && !scene.scene().film().interval)
            throw core::InputError(
                "a limit on the error needs the two halves of the passes: set the film's 'interval' "
                "(film.interval=true)");
        if (settings.stop.error && !plan_.error_is_known())
            throw core::InputError(
                "the error of this image is not known, and a limit on it would not end the render: " +
                plan_.no_error_because());
        if (settings.begin_with && settings.begin_with->scene_hash != hash_)
            throw core::InputError(
                "the passes that this render begins with are of another one: the scene, a file that it "
                "names, or the version of mote has changed since");
    }

    Rendered run() {
        BorrowedArena arena(threads_);
        return arena.execute([&] { return render_here(); });
    }

  private:
    core::RenderRequest request() {
        core::RenderRequest r;
        r.seed = settings_.seed, r.stop = settings_.stop, r.range = settings_.range;
        r.enough = settings_.enough;
        r.seconds_before = settings_.seconds_before, r.seconds_after = settings_.seconds_after;
        if (settings_.begin_with) r.begin_with = settings_.begin_with->film.get();
        r.checkpoint_path = settings_.checkpoint, r.checkpoint_every_seconds = settings_.checkpoint_every;
        r.checkpoint_at_end = settings_.keep_checkpoint, r.resume = settings_.resume;
        // Channels at pixel centres and the numbers of objects, with what they are made of.
        constexpr double center_bytes = 200.0;
        const core::FilmSettings& size = scene_.scene().film();
        r.memory = settings_.memory.without(
            settings_.auxiliary ? center_bytes * double(size.width) * double(size.height) : 0.0);
        r.noise_is_known = plan_.noise_unknown.empty();
        if (size.interval) r.split = plan_.split();
        r.content_hash = hash_, r.features = features_of(scene_, settings_);
        r.interrupted = &watched_.stop(), r.time_is_over = &watched_.time_is_over();
        r.keep_part_of_first_pass = !settings_.range;
        r.building_is_over = [this] { watched_.begin_passes(); };
        r.passes_are_over = [this] { watched_.end_passes(); };
        r.checkpoint_failed = [this](const std::string& why) {
            watched_.report(why + "; it is tried again");
        };
        r.progress = [this](const core::RenderProgress& p) { watched_.report(p); };
        r.abandoned = &watched_.abandoned();
        const RenderObserver& observer = watched_.observer();
        r.preview_every_seconds = observer.preview_every_seconds();
        r.preview_share = observer.preview_share();
        r.first_preview_is_raw = observer.first_preview_is_raw();
        r.previews_are_whole = observer.previews_are_whole();
        r.finish = settings_.finish;
        r.preview_is_seen = [&observer] { return observer.preview_is_seen(); };
        if (wants_previews_)
            r.preview = [this, &observer](const core::Film& film,
                                          const std::optional<core::PictureError>& error) {
                watched_.report(preview_of(film, error, observer.wants_layers()));
            };
        return r;
    }

    Rendered render_here() {
        core::RenderResult result = core::render(scene_.scene(), scene_.integrator(), request());
        if (watched_.abandoned()) return {};
        result.statistics.seconds["load"] = scene_.load_seconds();
        if (settings_.begin_with) add_statistics(result.statistics, settings_.begin_with->statistics);
        if (result.film.pass_count() == 0 && !watched_.cancelled())
            throw core::InputError(
                "the time is over before the first pixel was complete: there is no picture");
        warn_of_time(result);
        const RenderReport report{scene_.scene(),
                                  plan_,
                                  result,
                                  hash_,
                                  scene_.scene_content(),
                                  settings_.seed,
                                  threads_,
                                  settings_.command_line,
                                  scene_.report().approximations};
        Rendered rendered;
        rendered.image.width = result.film.width(), rendered.image.height = result.film.height();
        if (result.film.pass_count() > 0 && !settings_.range) {
            const core::Stopwatch stopwatch(result.statistics.seconds["finish"]);
            rendered.image = core::with_memory_for("the picture", [&] { return picture(report); });
        }
        denoise(rendered.image, result);
        rendered.statistics = statistics_json(report);
        if (!settings_.checkpoint.empty() && !result.interrupted && !settings_.keep_checkpoint)
            core::remove_checkpoint(settings_.checkpoint, hash_);
        take_over(std::move(result), rendered);
        return rendered;
    }
    core::ImageChannels picture(const RenderReport& report) const {
        return make_picture(report, scene_.registry(),
                            {settings_.auxiliary, settings_.auxiliary || settings_.denoise == "bmfr"});
    }
    /// A pass can be so long, and so hard to cut, that the limit in time does not hold.
    void warn_of_time(core::RenderResult& result) const {
        if (!settings_.stop.seconds || settings_.range) return;
        double seconds = settings_.seconds_before;
        for (const char* phase : {"build", "render"})
            if (const auto it = result.statistics.seconds.find(phase); it != result.statistics.seconds.end())
                seconds += it->second;
        if (seconds > *settings_.stop.seconds + max_seconds_late_of_passes)
            result.statistics.warnings.push_back(
                fmt::format("the limit of {:.3g} s was exceeded: building and {} pass{} took {:.3g} s",
                            *settings_.stop.seconds, result.film.pass_count(),
                            result.film.pass_count() == 1 ? "" : "es", seconds));
    }
    static constexpr double max_seconds_late_of_passes = core::max_seconds_late + 1.0;

    /// A whole picture only; one that cannot be denoised is worth more than none.
    void denoise(core::ImageChannels& image, core::RenderResult& result) const {
        if (!denoiser_ || settings_.range || result.interrupted || !result.finished_pixels.empty() ||
            !result.film.has_passes(1))
            return;
        const core::Stopwatch stopwatch(result.statistics.seconds["denoise"]);
        try {
            denoiser_(image);
        } catch (const core::InputError& error) {
            result.statistics.warnings.push_back(std::string("not denoised: ") + error.what());
        }
    }
    void take_over(core::RenderResult&& result, Rendered& rendered) const {
        rendered.passes = result.finished_pixels.empty() ? result.film.pass_count() : 0;
        if (const auto noise = result.statistics.values.find("noise");
            noise != result.statistics.values.end())
            rendered.noise = noise->second;
        rendered.error = result.error;
        rendered.interrupted = result.interrupted;
        rendered.missing_layers = result.film.layers_without_passes();
        rendered.finished_for = result.finished_for;
        rendered.finished_pixels = std::move(result.finished_pixels);
        rendered.checkpoint_problem = std::move(result.checkpoint_problem);
        rendered.warnings = result.statistics.warnings;
        rendered.counts = std::move(result.statistics);
        if (settings_.range) rendered.film = std::move(result.film);
    }

    const LoadedScene& scene_;
    const RenderSettings& settings_;
    WatchedWork& watched_;
    bool wants_previews_;
    int threads_;
    Denoiser denoiser_;
    core::Plan plan_;
    std::string hash_;
};

}  // namespace

Rendered render(const LoadedScene& scene, const RenderSettings& settings, RenderObserver& observer) {
    std::optional<double> seconds = settings.stop.seconds;
    if (settings.range) seconds.reset();
    if (seconds) *seconds -= settings.seconds_before;
    WatchedWork watched(seconds, observer);
    RenderWork work(scene, settings, watched, observer.wants_previews());
    return watched.run([&work] { return work.run(); });
}

Rendered render(const LoadedScene& scene, const RenderSettings& settings) {
    RenderObserver silent;
    return render(scene, settings, silent);
}

std::string render_hash(const LoadedScene& scene, const RenderSettings& settings) {
    const bool motion = settings.frame_before && settings.auxiliary;
    return scene.scene_hash(motion ? settings.frame_before->settings : std::vector<std::string>());
}

}  // namespace mote::session
