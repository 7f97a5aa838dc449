#include "session/render.h"

#include <tbb/info.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "core/render/stop_clock.h"
#include "session/auxiliary_channels.h"
#include "session/borrowed_arena.h"
#include "session/denoise/bmfr_sequence.h"
#include "session/denoise/denoised_layer.h"
#include "session/render_report.h"
#include "session/usable_threads.h"
#include "session/watched_work.h"

namespace mote::session {

namespace {

using Denoiser = std::function<void(core::ImageChannels&)>;

/// What is missing is said before the first pass, not after the last.
Denoiser denoiser_of(const std::string& method, int threads) {
    if (method.empty()) return {};
    if (method == "oidn")
        return [library = std::make_shared<OidnLibrary>(threads)](core::ImageChannels& image) {
            add_denoised_layer(image, *library);
        };
    if (method == "bmfr")
        return [](core::ImageChannels& image) { BmfrSequence(true).add_denoised_layer(image); };
    const std::vector<std::string> known = {"oidn", "bmfr"};
    throw core::InputError("there is no denoiser '" + core::printable(method) + "'" +
                           core::suggestion(method, known));
}

/// One render in its own thread, as WatchedWork sees it.
class RenderWork {
  public:
    RenderWork(const LoadedScene& scene, const RenderSettings& settings, WatchedWork& watched)
        : scene_(scene),
          settings_(settings),
          watched_(watched),
          threads_(
              usable_threads(settings.threads > 0 ? settings.threads : tbb::info::default_concurrency())),
          denoiser_(denoiser_of(settings.denoise, threads_)),
          plan_(scene.plan()),
          hash_(scene.scene_hash()) {}

    Rendered run() {
        BorrowedArena arena(threads_);
        return arena.execute([&] { return render_here(); });
    }

  private:
    core::RenderRequest request() {
        core::RenderRequest r;
        r.seed = settings_.seed, r.stop = settings_.stop;
        r.checkpoint_path = settings_.checkpoint, r.checkpoint_every_seconds = settings_.checkpoint_every;
        r.checkpoint_at_end = false, r.resume = settings_.resume;
        r.content_hash = hash_;
        r.features =
            wanted_features(scene_.scene(), scene_.report().features, settings_.auxiliary, settings_.denoise);
        r.interrupted = &watched_.stop(), r.time_is_over = &watched_.time_is_over();
        r.keep_part_of_first_pass = true;
        r.building_is_over = [this] { watched_.begin_passes(); };
        r.passes_are_over = [this] { watched_.forget_time(); };
        if (settings_.progress) r.progress = [this](const core::RenderProgress& p) { watched_.tell(p); };
        if (settings_.preview)
            r.preview = [this](const core::Film& film) {
                core::ImageChannels image;
                image.width = film.width(), image.height = film.height();
                image.add_rgb("", film.beauty());
                watched_.show(std::move(image));
            };
        return r;
    }

    Rendered render_here() {
        core::RenderResult result = core::render(scene_.scene(), scene_.integrator(), request());
        result.statistics.seconds["load"] = scene_.load_seconds();
        if (result.film.pass_count() == 0 && !watched_.cancelled())
            throw core::InputError(
                "the time is over before the first pixel was complete: there is no picture");
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
        if (result.film.pass_count() > 0)
            rendered.image = core::with_memory_for("the picture", [&] {
                return make_picture(
                    report, scene_.registry(),
                    {settings_.auxiliary, settings_.auxiliary || settings_.denoise == "bmfr"});
            });
        denoise(rendered.image, result);
        rendered.statistics = statistics_json(report);
        rendered.warnings = result.statistics.warnings;
        rendered.passes = result.finished_pixels.empty() ? result.film.pass_count() : 0;
        if (const auto noise = result.statistics.values.find("noise");
            noise != result.statistics.values.end())
            rendered.noise = noise->second;
        rendered.interrupted = result.interrupted;
        std::error_code ignored;
        if (!result.interrupted && !settings_.checkpoint.empty())
            std::filesystem::remove(settings_.checkpoint, ignored);
        return rendered;
    }
    /// Of a whole picture; one that cannot be denoised is worth more than none.
    void denoise(core::ImageChannels& image, core::RenderResult& result) const {
        if (!denoiser_ || result.interrupted || !result.finished_pixels.empty() || !result.film.has_passes(1))
            return;
        try {
            denoiser_(image);
        } catch (const core::InputError& error) {
            result.statistics.warnings.push_back(std::string("not denoised: ") + error.what());
        }
    }

    const LoadedScene& scene_;
    const RenderSettings& settings_;
    WatchedWork& watched_;
    int threads_;
    Denoiser denoiser_;
    core::Plan plan_;
    std::string hash_;
};

}  // namespace

Rendered render(const LoadedScene& scene, const RenderSettings& settings) {
    WatchedWork watched(settings);
    RenderWork work(scene, settings, watched);
    return watched.run([&work] { return work.run(); });
}

}  // namespace mote::session
