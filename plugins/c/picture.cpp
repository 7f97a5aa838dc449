// Pictures of the C interface: rendering, layers, files.
#include <span>

#include "core/formats/pictures/image_file.h"
#include "plugins/c/handles.h"
#include "session/borrowed_arena.h"
#include "session/denoise/bmfr_sequence.h"
#include "session/denoise/denoised_layer.h"
#include "session/output_files.h"
#include "session/picture_compensation.h"

namespace mote::c {

namespace {

/// Changes the picture, or leaves it as it was.
template <typename Change>
mote_status change(mote_picture* picture, const Change& change_now) {
    if (!picture) return MOTE_INVALID_ARGUMENT;
    return guarded(picture->error, [&] {
        change_now(picture->rendered);
        picture->layers = session::layers_of(picture->rendered.image);
    });
}

/// Calls the functions of the host.
class HostObserver : public session::RenderObserver {
  public:
    explicit HostObserver(const mote_render_options& options) : options_(options) {}

    void progress(const core::RenderProgress& p) override {
        if (!options_.progress) return;
        const mote_progress progress = {
            sizeof(mote_progress), p.passes, p.passes_wanted.value_or(0), p.seconds, p.seconds_left, p.noise};
        options_.progress(options_.user, &progress);
    }
    bool cancelled() override { return options_.cancelled && options_.cancelled(options_.user) != 0; }
    bool wants_previews() const override { return options_.preview != nullptr; }
    void preview(const core::ImageChannels& image) override {
        const std::vector<core::Rgb> beauty = image.rgb("");
        options_.preview(options_.user, image.width, image.height, &beauty.front().x);
    }

  private:
    const mote_render_options& options_;
};

session::RenderSettings settings_of(const mote_render_options& o) {
    session::RenderSettings s;
    const bool in_range = o.seconds >= 0.0 && o.noise >= 0.0 && o.checkpoint_every >= 0.0 && o.threads >= 0 &&
                          o.threads <= 4096;
    if (!in_range)
        throw InvalidArgument("seconds, noise, checkpoint_every and threads (to 4096) are not negative");
    if (o.passes > 0) s.stop.passes = o.passes;
    if (o.seconds > 0.0) s.stop.seconds = o.seconds;
    if (o.noise > 0.0) s.stop.noise = o.noise;
    s.seed = o.seed, s.threads = o.threads, s.auxiliary = o.auxiliary != 0;
    if (o.denoise) s.denoise = o.denoise;
    if (o.checkpoint) s.checkpoint = o.checkpoint;
    if (o.checkpoint_every > 0.0) s.checkpoint_every = o.checkpoint_every;
    s.resume = o.resume != 0;
    if (s.resume && s.checkpoint.empty()) throw InvalidArgument("to resume needs a checkpoint");
    return s;
}

}  // namespace

}  // namespace mote::c

using namespace mote;
using mote::c::required;

mote_picture* mote_picture_new(void) { return new (std::nothrow) mote_picture; }
void mote_picture_free(mote_picture* picture) { delete picture; }

mote_status mote_render(const mote_scene* scene, const mote_render_options* given, mote_picture* picture) {
    return c::change(picture, [&](session::Rendered& rendered) {
        const mote_render_options options = c::known_options(given);
        if (!required(scene, "the scene").loaded) throw c::InvalidArgument("the scene is not loaded");
        c::HostObserver observer(options);
        rendered = session::render(*scene->loaded, c::settings_of(options), observer);
    });
}

const char* mote_picture_error(const mote_picture* picture) {
    return picture ? picture->error.text() : "the picture is null";
}
const char* mote_picture_error_file(const mote_picture* picture) {
    return picture ? picture->error.file() : "";
}
int mote_picture_error_line(const mote_picture* picture) { return picture ? picture->error.line() : 0; }

int mote_picture_width(const mote_picture* picture) { return picture ? picture->rendered.image.width : 0; }
int mote_picture_height(const mote_picture* picture) { return picture ? picture->rendered.image.height : 0; }
uint32_t mote_picture_passes(const mote_picture* picture) { return picture ? picture->rendered.passes : 0; }
int mote_picture_interrupted(const mote_picture* picture) { return picture && picture->rendered.interrupted; }
double mote_picture_noise(const mote_picture* picture) {
    return picture ? picture->rendered.noise : core::infinity;
}
const char* mote_picture_statistics(const mote_picture* picture) {
    return picture ? picture->rendered.statistics.c_str() : "";
}
size_t mote_picture_warning_count(const mote_picture* picture) {
    return picture ? picture->rendered.warnings.size() : 0;
}
const char* mote_picture_warning(const mote_picture* picture, size_t index) {
    return picture && index < picture->rendered.warnings.size() ? picture->rendered.warnings[index].c_str()
                                                                : nullptr;
}
const char* mote_picture_metadata(const mote_picture* picture, const char* name) {
    if (!picture || !name) return nullptr;
    const auto& metadata = picture->rendered.image.metadata;
    for (const auto& [key, value] : metadata)
        if (key == name) return value.c_str();
    return nullptr;
}

size_t mote_picture_layer_count(const mote_picture* picture) { return picture ? picture->layers.size() : 0; }
const char* mote_picture_layer_name(const mote_picture* picture, size_t index) {
    return picture && index < picture->layers.size() ? picture->layers[index].name.c_str() : nullptr;
}
int mote_picture_layer_channels(const mote_picture* picture, const char* name) {
    if (!picture || !name) return 0;
    for (const session::LayerChannels& layer : picture->layers)
        if (layer.name == name) return int(layer.channels.size());
    return 0;
}

mote_status mote_picture_read(mote_picture* picture, const char* name, float* values, size_t count) {
    if (!picture) return MOTE_INVALID_ARGUMENT;
    bool too_small = false;
    const mote_status status = c::guarded(picture->error, [&] {
        const core::ImageChannels& image = picture->rendered.image;
        const session::LayerChannels layer = session::find_layer(image, &required(name, "the name"));
        const std::size_t wanted = std::size_t(image.width) * std::size_t(image.height) * layer.planes.size();
        if (count < wanted) {
            too_small = true;
            throw c::InvalidArgument("the layer has " + std::to_string(wanted) +
                                     " floats, and the buffer room for " + std::to_string(count));
        }
        session::copy_layer(image, layer, std::span(&required(values, "the buffer"), wanted));
    });
    return too_small ? MOTE_BUFFER_TOO_SMALL : status;
}

mote_status mote_picture_write(mote_picture* picture, const char* name, int width, int height, int channels,
                               const float* values) {
    return c::change(picture, [&](session::Rendered& rendered) {
        if (width < 1 || height < 1 || (channels != 1 && channels != 3))
            throw c::InvalidArgument("a layer has at least one pixel, and one or three channels");
        const std::size_t count = std::size_t(width) * std::size_t(height) * std::size_t(channels);
        session::set_layer(rendered.image, &required(name, "the name"), width, height, channels,
                           std::span(&required(values, "the buffer"), count));
    });
}

mote_status mote_picture_set_metadata(mote_picture* picture, const char* name, const char* value) {
    return c::change(picture, [&](session::Rendered& rendered) {
        rendered.image.metadata[&required(name, "the name")] = &required(value, "the value");
    });
}

mote_status mote_picture_load(mote_picture* picture, const char* path) {
    return c::change(picture, [&](session::Rendered& rendered) {
        session::Rendered read;
        read.image = core::read_exr(&required(path, "the path"));
        rendered = std::move(read);
    });
}

mote_status mote_picture_save(mote_picture* picture, const char* path, int half) {
    return c::change(picture, [&](session::Rendered& rendered) {
        if (rendered.image.names.empty()) throw c::InvalidArgument("the picture has no layers");
        session::require_exr_name(&required(path, "the path"));
        core::write_exr(path, rendered.image, half != 0);
    });
}

mote_status mote_picture_compensate(mote_picture* picture, const mote_ssbc_options* given) {
    return c::change(picture, [&](session::Rendered& rendered) {
        const mote_ssbc_options options = c::known_options(given);
        screenspace::SsbcSettings settings;
        settings.bound = float(options.bound), settings.hierarchical = options.flat == 0;
        if (options.steps != 0) settings.steps = options.steps;
        settings.half_resolution = options.half_resolution != 0, settings.blur = float(options.blur);
        core::ImageChannels image = rendered.image;
        session::compensate_picture(image, settings, {}, options.replace != 0);
        rendered.image = std::move(image);
    });
}

mote_status mote_picture_denoise(mote_picture* picture, const char* method, int threads) {
    return c::change(picture, [&](session::Rendered& rendered) {
        session::BorrowedArena(threads).execute(
            [&] { session::make_denoiser(&required(method, "the method"), threads)(rendered.image); });
    });
}
