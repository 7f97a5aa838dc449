#include "apps/command_observer.h"

#include <fmt/format.h>

#include <filesystem>

#include "apps/render_messages.h"
#include "session/coarse_preview.h"
#include "session/preview.h"

namespace mote::apps {

namespace {

std::string first_line(const LoadedScene& scene, int threads) {
    const core::Scene& s = scene.scene();
    return fmt::format("mote: {}: {}, {} x {} pixels, {} thread{}", s.parts().file, scene.integrator().type(),
                       s.film().width, s.film().height, threads, threads == 1 ? "" : "s");
}

}  // namespace

bool waits_for_reader(const RenderFiles& files) {
    std::error_code ignored;
    return std::filesystem::is_fifo(files.picture, ignored) ||
           std::filesystem::is_fifo(files.preview, ignored);
}

CommandObserver::CommandObserver(const RenderArguments& arguments, const RenderFiles& files,
                                 const LoadedScene& scene, int threads, Interruption& interruption)
    : arguments_(arguments),
      scene_(scene),
      preview_file_(waits_for_reader(files) ? "" : files.preview),
      interruption_(interruption),
      line_(first_line(scene, threads), arguments.quiet) {
    const auto& film = scene.scene().film();
    if (!arguments.tev.empty()) viewer_.emplace(arguments.tev, files.picture, film.width, film.height);
}

void CommandObserver::preview(const core::ImageChannels& image) {
    if (!preview_file_.empty()) write_preview(preview_file_, image, arguments_.exposure);
    show(image.rgb(""));
}

void CommandObserver::show_coarse(const RenderSettings& settings) {
    const bool watched = wants_previews() && (!arguments_.quiet || viewer_);
    if (!watched || !session::coarse_preview_pays(scene_, settings)) return;
    const auto image = session::coarse_preview(scene_, settings, *this);
    if (!image) return;
    preview(*image);
    showed_whole_ = true;
}

bool CommandObserver::preview_is_seen() const {
    constexpr std::chrono::seconds long_render{30};
    return !arguments_.quiet || arguments_.seconds || viewer_ ||
           (wants_previews() && std::chrono::steady_clock::now() - start_ > long_render);
}

void CommandObserver::warning(const std::string& text) {
    if (!arguments_.quiet) note("warning: " + text);
}

void CommandObserver::building_is_over() {
    interruption_.set_alarm(std::nullopt);
    interruption_.end_at_once_while(nullptr);
}

void CommandObserver::end(const Rendered& rendered) {
    line_.end();
    show(rendered.film ? rendered.film->beauty() : rendered.image.rgb(""));
}

void CommandObserver::show(std::vector<core::Rgb> picture) {
    if (viewer_ && !picture.empty()) viewer_->show(std::move(picture));
}

}  // namespace mote::apps
