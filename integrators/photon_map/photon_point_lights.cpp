// The photons of `mote_photon_map` that an estimate of a pixel holds.
#include <fmt/format.h>

#include "integrators/photon_map/photon_map_estimator.h"

namespace mote::integrators {

using namespace core;

namespace {

LightPoint point_of(const gathering::Photon& photon) { return {photon.position, photon.power, photon.depth}; }

/// Photons are numbered on surfaces first, then in media.
template <bool Media>
class PhotonPointLights final : public PointLights, private PhotonMapEstimator<Media> {
    using Base = PhotonMapEstimator<Media>;
    using Base::options_, Base::scene_, Base::settings_;

  public:
    PhotonPointLights(const Scene& scene, const RenderOptions& options, const PhotonMapSettings& settings)
        : Base(scene, options, settings) {}
    std::string kind() const override { return "photon"; }

    std::vector<LightPoint> points(const PassContext& context) override {
        const PhotonMaps maps = this->make_maps(context.index, context.cancelled);
        std::vector<LightPoint> points;
        for (const gathering::Photon& photon : maps.surface.photons()) points.push_back(point_of(photon));
        for (const gathering::Photon& photon : maps.volume.photons()) points.push_back(point_of(photon));
        return points;
    }

    PixelLight light_of(const PassContext& context, int x, int y) override {
        const PhotonMaps maps = this->make_maps(context.index, context.cancelled);
        PixelLight light;
        const auto visit = [&](PhotonPlace place, std::uint32_t photon, const Rgb& arrived) {
            ++light.connected;
            if (is_black(arrived)) return;
            const bool surface = place == PhotonPlace::surface;
            const gathering::Photon& p =
                surface ? maps.surface.photons()[photon] : maps.volume.photons()[photon];
            light.sources.push_back({photon + (surface ? 0 : maps.surface.size()), point_of(p), arrived});
        };
        WalkContext walk;
        walk.cancelled = context.cancelled;
        PhotonScratch scratch;
        const EyeRay eye = make_eye_ray(scene_, options_, context, x, y);
        walk.rng = eye.rng;
        PhotonEyePath<Media, decltype(visit)>(scene_, settings_.eye, maps, walk, scratch, visit).trace(eye);
        light.facts = {{"photons", fmt::format("{} of {} light paths",
                                               maps.surface.size() + maps.volume.size(), settings_.paths)},
                       {"estimate", fmt::format("the {} nearest on a surface, discs along the ray in media",
                                                settings_.neighbours)}};
        return light;
    }
};

}  // namespace

std::unique_ptr<PointLights> make_photon_point_lights(const Scene& scene, const RenderOptions& options,
                                                      const PhotonMapSettings& settings) {
    if (scene.has_media()) return std::make_unique<PhotonPointLights<true>>(scene, options, settings);
    return std::make_unique<PhotonPointLights<false>>(scene, options, settings);
}

}  // namespace mote::integrators
