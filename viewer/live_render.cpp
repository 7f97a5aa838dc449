#include "viewer/live_render.h"

#include <algorithm>
#include <cmath>

#include "core/formats/xml/integrator_maker.h"
#include "core/formats/xml/scene_element.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "core/render/cpu_clock.h"
#include "viewer/wish_changes.h"

namespace mote::viewer {

namespace {

using session::LoadedScene, session::SceneChanges;

/// A newer wish replaces this render.
struct Superseded {};

bool same(const SceneChanges& a, const SceneChanges& b) {
    return a.defines == b.defines && a.lenient == b.lenient && a.integrator == b.integrator;
}

/// Tag of the value element of an integrator's parameter.
std::string tag_of(const core::Registry& registry, const std::string& type, const std::string& name) {
    const core::Manual* manual = registry.find(core::Category::integrator, type);
    if (!manual) return "string";
    for (const core::Parameter& p : manual->parameters)
        if (p.name == name)
            return p.type == "boolean" || p.type == "integer" || p.type == "float" || p.type == "rgb"
                       ? p.type
                       : "string";
    return "string";
}

/// The integrator of the changes, for a scene that was loaded without them. Changes that name no integrator
/// leave the scene's own.
LoadedScene with_integrator(const LoadedScene& scene, const SceneChanges& changes) {
    std::vector<core::IntegratorSetting> settings;
    std::string type = changes.integrator;
    for (const auto& [path, value] : changes.defines) {
        if (!is_of_integrator(path)) continue;
        const std::string name = path.substr(path.find('.') + 1);
        if (name == "type")
            type = value;
        else
            settings.push_back({name, "", value, {"-D " + path + "=" + value, 0}});
    }
    if (type.empty() && settings.empty()) return scene;
    if (type.empty()) type = scene.integrator().type();
    for (core::IntegratorSetting& s : settings) s.tag = tag_of(scene.registry(), type, s.name);
    std::vector<std::string> warnings, texts = {type};
    for (const core::IntegratorSetting& s : settings) texts.push_back(s.name + "=" + s.text);
    return scene.rendered_by(
        core::make_integrator(scene.registry(), scene.scene(), type, settings, {"--integrator", 0}, warnings),
        texts);
}

/// Loads `scene` again where `changes` differ from its own outside of the integrator.
LoadedScene changed(const LoadedScene& scene, const SceneChanges& changes) {
    const SceneChanges wanted = outside_integrator(changes);
    return same(scene.changes(), wanted) ? scene : scene.reloaded(wanted);
}

}  // namespace

class LiveRender::Observer : public session::RenderObserver {
  public:
    Observer(LiveRender& render, const Wish& wish, std::uint64_t change, bool coarse)
        : render_(render), wish_(wish), change_(change), coarse_(coarse) {}

    void progress(const core::RenderProgress& p) override {
        if (!coarse_) render_.reports_.progress(change_, p);
    }
    bool wants_previews() const override { return !coarse_; }
    bool wants_layers() const override { return true; }
    double preview_every_seconds() const override { return 0.25; }
    /// Someone watches: denoising may take a fifth of the time.
    double preview_share() const override { return 0.2; }
    bool first_preview_is_raw() const override { return true; }
    bool preview_is_seen() const override { return render_.reports_.is_seen(); }
    void preview(const core::ImageChannels& image) override {
        session::Rendered rendered;
        rendered.image = image;
        rendered.passes = std::uint32_t(std::stoul(image.metadata.at("passes")));
        rendered.noise = std::stod(image.metadata.at("noise"));
        rendered.interrupted = true;
        render_.report(std::move(rendered), wish_, change_, false, core::wall_seconds() - start_);
    }
    /// A coarse picture is made to its end unless it takes long: while the camera moves, every picture would
    /// be superseded otherwise.
    bool cancelled() override {
        constexpr double patience = 0.4;
        if (render_.is_superseded(change_) && (!coarse_ || core::wall_seconds() - start_ > patience))
            throw Superseded();
        return !coarse_ && render_.stop_;
    }

  private:
    LiveRender& render_;
    const Wish& wish_;
    std::uint64_t change_;
    bool coarse_;
    const double start_ = core::wall_seconds();
};

LiveRender::LiveRender(const LoadedScene& scene, Reports reports)
    : reports_(std::move(reports)), scene_(scene), thread_([this] { run(); }) {}

LiveRender::~LiveRender() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
        ++change_;
    }
    changed_.notify_all();
    thread_.join();
}

std::uint64_t LiveRender::render(const Wish& wish) {
    std::uint64_t change = 0;
    {
        const std::lock_guard lock(mutex_);
        wish_ = wish;
        stop_ = false;
        change = ++change_;
    }
    changed_.notify_all();
    return change;
}

void LiveRender::stop() { stop_ = true; }

LoadedScene LiveRender::scene_for(const SceneChanges& changes) {
    const std::lock_guard lock(scene_mutex_);
    scene_ = changed(*scene_, changes);
    return with_integrator(*scene_, changes);
}

void LiveRender::run() {
    for (std::uint64_t done = 0;;) {
        Wish wish;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] { return quit_ || change_ != done; });
            if (quit_) return;
            wish = wish_, done = change_;
        }
        show(wish, done);
    }
}

void LiveRender::show(const Wish& wish, std::uint64_t change) {
    try {
        show_coarse(wish, change);
        if (!wish.moving && !is_superseded(change)) show_full(wish, change);
    } catch (const Superseded&) {
    } catch (const core::OutOfMemory& error) {
        reports_.problem(change, std::string("there is not enough memory for ") + error.what());
    } catch (const std::exception& error) {
        reports_.problem(change, error.what());
    }
}

/// One pass over as many pixels as take about a tenth of a second, reported at once; then four times as many,
/// where a whole pass takes longer than one likes to wait.
void LiveRender::show_coarse(const Wish& wish, std::uint64_t change) {
    constexpr double patience = 1.0;
    std::optional<LoadedScene> loaded;
    {
        const std::lock_guard lock(scene_mutex_);
        loaded = scene_;
    }
    const core::FilmSettings& film = loaded->scene().film();
    double fraction = double(coarse_pixels_) / (double(film.width) * double(film.height));
    for (bool first = true;; first = false, fraction *= 4.0) {
        const double factor = std::sqrt(std::min(1.0, fraction));
        const auto shrunk = [&](int size) { return std::max(1, int(std::lround(factor * size))); };
        const double seconds = show_at_size(wish, change, *loaded, shrunk(film.width), shrunk(film.height));
        if (first) adapt(seconds);
        if (wish.moving || is_superseded(change) || fraction > 0.2 || seconds / fraction < patience) return;
    }
}

/// Returns the time that it took [s].
double LiveRender::show_at_size(const Wish& wish, std::uint64_t change, const LoadedScene& loaded, int width,
                                int height) {
    const double start = core::wall_seconds();
    const SceneChanges changes = session::at_size(wish.changes, width, height);
    coarse_scene_ = changed(coarse_scene_ ? *coarse_scene_ : loaded, changes);
    const LoadedScene scene = with_integrator(*coarse_scene_, changes);
    session::RenderSettings settings;
    settings.seed = wish.seed, settings.threads = wish.threads, settings.stop.passes = 1;
    settings.finish = false;  // to denoise it takes longer than to render it
    Observer observer(*this, wish, change, true);
    session::Rendered rendered = session::render(scene, settings, observer);
    const double seconds = core::wall_seconds() - start;
    report(std::move(rendered), wish, change, true, seconds);
    return seconds;
}

void LiveRender::adapt(double seconds) {
    constexpr std::size_t min_pixels = 512, max_pixels = std::size_t(1) << 20;
    if (seconds > 0.15) coarse_pixels_ = std::max(min_pixels, coarse_pixels_ / 2);
    if (seconds < 0.05) coarse_pixels_ = std::min(max_pixels, coarse_pixels_ * 2);
}

void LiveRender::show_full(const Wish& wish, std::uint64_t change) {
    const double start = core::wall_seconds();
    const LoadedScene scene = scene_for(wish.changes);
    session::RenderSettings settings;
    settings.seed = wish.seed, settings.threads = wish.threads;
    settings.stop.passes = wish.passes > 0 ? wish.passes : std::uint32_t(scene.scene().film().sample_count);
    Observer observer(*this, wish, change, false);
    session::Rendered rendered = session::render(scene, settings, observer);
    report(std::move(rendered), wish, change, false, core::wall_seconds() - start);
}

void LiveRender::report(session::Rendered&& rendered, const Wish& wish, std::uint64_t change, bool coarse,
                        double seconds) const {
    auto picture = std::make_shared<LivePicture>();
    picture->image = std::move(rendered.image), picture->wish = wish;
    // A filter of fewer passes, as after an interruption, is not what `mote render` makes.
    picture->passes = rendered.finished_for ? 0 : rendered.passes;
    picture->noise = rendered.noise, picture->coarse = coarse, picture->seconds = seconds;
    picture->finished = !rendered.interrupted && !coarse, picture->change = change;
    if (!picture->image.names.empty()) reports_.picture(picture);
}

}  // namespace mote::viewer
