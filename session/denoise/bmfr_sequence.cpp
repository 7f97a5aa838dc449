#include "session/denoise/bmfr_sequence.h"

#include <algorithm>

#include "core/objects/error.h"
#include "session/denoise/beauty_layers.h"
#include "session/denoise/bmfr_features.h"
#include "session/denoise/denoised_layer.h"
#include "session/denoise/frame_camera.h"
#include "session/reference_metadata.h"

namespace mote::session {

using namespace core;
using screenspace::DenoiserFrame;

namespace {

/// Light that was scattered first in a medium, as seen from the eye.
bool of_media(const std::string& layer) {
    return layer.starts_with("single_scattering") || layer.starts_with("multiple_scattering") ||
           layer.starts_with("compensation_volume");
}

void add(std::vector<Rgb>& sum, const std::vector<Rgb>& part) {
    if (sum.empty()) sum.assign(part.size(), Rgb(0.0f));
    for (std::size_t p = 0; p < part.size(); ++p) sum[p] += part[p];
}

/// The light of a picture by what it is a function of.
struct LightOfPicture {
    std::vector<Rgb> surfaces, media, emission;
    std::string done;  ///< names of what is denoised

    LightOfPicture(const ImageChannels& image, std::span<const Rgb> beauty) {
        const std::vector<std::string> layers = layers_of_beauty(image);
        if (!layers_add_up(image, layers, beauty)) {
            surfaces.assign(beauty.begin(), beauty.end()), done = "the beauty as a whole";
            return;
        }
        std::vector<std::string> names;
        for (const std::string& layer : layers) {
            const bool emitted = layer == "emission";
            add(emitted ? emission : of_media(layer) ? media : surfaces, image.rgb(layer));
            if (!emitted) names.push_back(layer);
        }
        if (surfaces.empty()) surfaces.assign(beauty.size(), Rgb(0.0f));
        done = joined(names);
    }
};

screenspace::DenoiserSettings settings(bool single) {
    screenspace::DenoiserSettings s;
    s.regression.overlapping = single;
    return s;
}

}  // namespace

BmfrSequence::BmfrSequence(bool single) : single_(single), denoiser_(settings(single)) {}

void BmfrSequence::add_denoised_layer(ImageChannels& image) {
    const std::vector<Rgb> beauty = image.rgb("");
    if (beauty.empty()) throw InputError("a picture without R, G and B cannot be denoised");
    if (!image.rgb(denoised_layer).empty()) throw InputError("it is denoised already");
    const BmfrFeatures known(image);
    const LightOfPicture light(image, beauty);
    const std::vector<Rgb> variance = variance_of_beauty(image);
    const auto camera = frame_camera(image, known.position());

    DenoiserFrame frame;
    frame.features = {image.width, image.height, known.position(),         known.normal(),
                      known.id(),  {},           known.previous_position()};
    bool connected = width_ == image.width && height_ == image.height;
    std::vector<Vec2> motion(known.motion().begin(), known.motion().end());
    const auto place = image.metadata.find("worldToCamera");
    const std::string camera_place = place != image.metadata.end() ? place->second : "";
    if (!motion.empty()) {
        // Infinitely far points stand still where the camera does.
        if (!camera_place.empty() && camera_place == camera_place_)
            for (Vec2& m : motion)
                if (!std::isfinite(m.x)) m = Vec2(0.0f);
    } else if (connected) {
        connected = camera && camera_;
        if (connected) motion = screenspace::camera_motion(known.position(), *camera, *camera_);
    }
    frame.features.motion = motion;
    frame.layers.push_back({light.surfaces, known.albedo(), known.of_surfaces()});
    if (!light.media.empty()) frame.layers.push_back({light.media, {}, known.of_media()});
    frame.variance = variance;
    if (width_ > 0 && layers_ != frame.layers.size())
        throw InputError("it has other layers than the frames before it");
    layers_ = frame.layers.size();

    std::vector<Rgb> sum = denoiser_.add(frame, connected);
    if (!light.emission.empty()) add(sum, light.emission);
    image.add_rgb(denoised_layer, sum);
    image.metadata[denoised_layer] =
        "the layer '" + denoised_layer + "', by block-wise feature regression: " + light.done + known.said() +
        (variance.empty() ? "" : ", blended by the variance") +
        (single_     ? ""
         : connected ? ", with the frames before"
                     : ", without frames before") +
        (denoiser_.filled()
             ? ", " + std::to_string(denoiser_.filled()) + " pixels that were not finite filled"
             : "") +
        "; all other layers are as they were measured";
    camera_ = camera, camera_place_ = camera_place, width_ = image.width, height_ = image.height;
}

}  // namespace mote::session
