// A reference is an ordinary render that ends when its own noise is small enough for the smallest error to be
// judged by it.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/integrator_maker.h"
#include "core/objects/error.h"
#include "core/render/checkpoint.h"
#include "session/output_files.h"
#include "session/preview.h"
#include "session/reference_metadata.h"
#include "session/render.h"
#include "trade/reference.h"
#include "trade/trade.h"

namespace mote::trade {

using namespace session;

namespace {

namespace fs = std::filesystem;

std::string preview_of(const std::string& path) { return fs::path(path).replace_extension(".png").string(); }
std::string checkpoint_of(const std::string& path) { return path + ".checkpoint"; }

std::string verdict(double noise, double smallest, double resolve) {
    if (!std::isfinite(noise)) return "one pass says nothing about its own noise";
    return fmt::format(
        "noise {:.3g} %: it judges errors down to {:.3g} %{}", 100.0 * noise, 100.0 * smallest,
        smallest <= resolve
            ? ""
            : fmt::format(", not the {:.3g} % requested; the same command renders on", 100.0 * resolve));
}

/// The scene with the integrator of the reference; adds to `warnings`.
LoadedScene with_integrator(const LoadedScene& scene, const ReferenceSettings& r,
                            std::vector<std::string>& warnings) {
    const std::string type = !r.integrator.empty()       ? r.integrator
                             : scene.scene().has_media() ? "volpath"
                                                         : "path";
    const core::Manual* manual = scene.registry().find(core::Category::integrator, type);
    std::vector<core::IntegratorSetting> settings;
    std::vector<std::string> texts = {"reference"};
    for (const auto& [name, value] : r.settings) {
        std::string tag = "string";  // of a name that is unknown, and refused as such
        if (manual)
            for (const core::Parameter& p : manual->parameters)
                if (p.name == name) tag = p.type;
        texts.push_back(name + "=" + value);
        settings.push_back({name, tag, value, {"--setting " + texts.back(), 0}});
    }
    return scene.rendered_by(core::make_integrator(scene.registry(), scene.scene(), type, settings,
                                                   {"--integrator " + type, 0}, warnings),
                             texts);
}

class ReferenceObserver : public RenderObserver {
  public:
    explicit ReferenceObserver(Host& host) : host_(host) {}
    void progress(const core::RenderProgress& p) override { host_.progress(p); }
    bool cancelled() override { return host_.interrupted(); }
    void warning(const std::string& text) override { host_.remark("warning: " + text); }
    void building_is_over() override { host_.idle_while(nullptr); }

  private:
    Host& host_;
};

RenderSettings render_settings_of(const Settings& s, const std::string& checkpoint) {
    RenderSettings render;
    std::error_code ignored;
    render.checkpoint = checkpoint, render.checkpoint_every = s.checkpoint_every;
    render.resume = !s.fresh && fs::exists(checkpoint, ignored), render.keep_checkpoint = true;
    render.enough = [resolve = s.resolve](const core::Film& film) { return smallest_error(film) <= resolve; };
    render.stop = {s.passes, s.seconds, {}, {}};
    render.threads = s.threads, render.command_line = s.command_line;
    return render;
}

double smallest_error_of(const core::ImageChannels& image) {
    const std::vector<core::Rgb> variance = variance_of_beauty(image);
    if (variance.empty() || !image.metadata.contains(variance_gain_key)) return core::infinity;
    return smallest_error(variance,
                          core::relative_weights(image.rgb(""), variance, image.width, image.height));
}

Rendered render_with_progress(const LoadedScene& scene, const RenderSettings& settings, Host& host,
                              const std::string& header) {
    ReferenceObserver observer(host);
    host.begin(header);
    try {
        Rendered rendered = session::render(scene, settings, observer);
        host.end();
        return rendered;
    } catch (...) {
        host.end();
        throw;
    }
}

}  // namespace

bool make_reference(const Settings& s, const ReferenceSettings& r, Host& host) {
    check_writable(r.path);
    host.idle_while("loading the scene");
    const LoadedScene loaded = LoadedScene::from_file(s.scene, s.changes);
    const NamedFile outputs[] = {{"the reference", r.path, r.named},
                                 {"its preview", preview_of(r.path), false},
                                 {"its checkpoint", checkpoint_of(r.path)}};
    check_outputs(outputs, scene_inputs(loaded.scene().parts().input_files));
    if (!s.fresh &&
        is_good_reference(r.path, loaded.scene(), loaded.scene_content(), {s.resolve, false, false})) {
        host.remark(r.path + " resolves this already (--fresh makes it anew)");
        return true;
    }
    std::vector<std::string> warnings;
    const LoadedScene scene = with_integrator(loaded, r, warnings);
    for (const std::string& text : scene.warnings()) host.remark(text);
    for (const std::string& text : warnings) host.remark("warning: " + text);
    for (const std::string& line : scene.plan().warnings()) host.remark(line);

    host.idle_while("building", "nothing is lost");
    const RenderSettings settings = render_settings_of(s, checkpoint_of(r.path));
    const Rendered rendered =
        render_with_progress(scene, settings, host,
                             fmt::format("mote: reference of {} by {} that judges errors down to {:.3g} %",
                                         s.scene, scene.integrator().type(), 100.0 * s.resolve));
    if (rendered.passes == 0) {
        if (!rendered.interrupted)
            throw core::InputError(
                "the time is over before the first pass was complete: there is no reference");
        host.note("interrupted before the first pass was complete: there is nothing to write");
        return false;
    }
    const double smallest = smallest_error_of(rendered.image);
    core::write_exr(r.path, rendered.image);
    write_preview(preview_of(r.path), rendered.image);
    for (const std::string& text : rendered.warnings) host.remark("warning: " + text);
    if (const auto bad = rendered.counts.non_finite_samples; bad > 0)
        host.note(fmt::format("WARNING: {} pixel samples were NaN or infinite and count as black", bad));
    host.remark(fmt::format("{} passes, {}", rendered.passes, verdict(rendered.noise, smallest, s.resolve)));
    if (rendered.interrupted)
        host.note("interrupted: the same command continues");
    else if (smallest <= s.resolve)
        core::remove_checkpoint(settings.checkpoint, render_hash(scene, settings));
    return !rendered.interrupted;
}

}  // namespace mote::trade
