#include "integrators/eye_path/image_loop.h"
#include "integrators/ray_bundles/atlas_eye_path.h"
#include "integrators/ray_bundles/atlas_scene.h"
#include "lights/emitters/other_lights.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Lights that rays of a bundle meet, or that no surface can sample.
std::vector<const Emitter*> lights_of_bundles(const Scene& scene) {
    std::vector<const Emitter*> result;
    for (const auto& emitter : scene.emitters())
        if (emitter->traits().can_be_hit() || emitter->traits().kind == EmitterKind::medium)
            result.push_back(emitter.get());
    return result;
}

/// With T_b the transport along a batch of directions, P the direct light and E the emitted one, every pass
/// takes the mean over batches b of
///   L_b = P + T_b L_{b-1}    (Hermes 2010, Sec. 5.5; gathering/radiance_exchange)
/// at the texels of an atlas, and shows it where eye paths meet the first diffuse surface.
class RayBundleEstimator final : public Estimator {
  public:
    RayBundleEstimator(const Scene& scene, const RenderOptions& options, const RayBundleSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          surfaces_(scene, settings, options.memory),
          others_(scene, lights_of_bundles(scene)),
          loop_(scene, options, {.eye_samples = settings.eye_samples, .by_rows = true}) {
        settings_.eye.wanted = options.cells;
        eye_.limits = settings_.eye;
        eye_.sample_direct = !settings.exchange.lights;
        if (others_.any()) eye_.other_lights = &others_;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        const std::uint64_t key = hash_keys(options_.seed, context.index, 0x62756e646c65ull);
        const gathering::TexelDirectLight sampled = sample_direct(key, context.cancelled);
        const gathering::ArrivingLight light = exchange(sampled, key, context.cancelled);
        const AtlasView view(surfaces_.atlas, surfaces_.locator, light, sampled);
        return loop_.run(context, image, {}, [&](EyeTask<false>& task) {
            AtlasEyePath path(scene_, eye_, view, task.walk());
            task.trace_each([&](const EyeRay& eye) { return path.trace(eye); });
        });
    }

    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        surfaces_.add_statistics(statistics);
        statistics.values["exchange_bytes"] = double(exchanged_.bytes);
        statistics.values["directions"] += double(exchanged_.directions);
        statistics.values["bundle_hits"] += double(exchanged_.hits);
    }

  private:
    bool wants_surfaces() const {
        return settings_.eye.wanted[Transport::direct] || settings_.eye.wanted[Transport::indirect];
    }

    gathering::TexelDirectLight sample_direct(std::uint64_t key, CancelToken cancelled) const {
        const bool all = !settings_.exchange.lights;
        if (!wants_surfaces() || (!all && !others_.any())) return {};
        const LitScene& lights = all ? static_cast<const LitScene&>(scene_) : others_;
        return gathering::texel_direct_light(lights, surfaces_.atlas, surfaces_.materials, light_samples, key,
                                             cancelled);
    }

    gathering::ArrivingLight exchange(const gathering::TexelDirectLight& sampled, std::uint64_t key,
                                      CancelToken cancelled) {
        if (!wants_surfaces()) {
            const std::vector<Rgb> dark(surfaces_.atlas.size());
            return {dark, dark};
        }
        const gathering::ExchangeScene scene{surfaces_.atlas, surfaces_.materials, surfaces_.tracer,
                                             scene_.environment()};
        return exchange_light(scene, settings_.exchange, sampled, key, cancelled, exchanged_);
    }

    const Scene& scene_;
    RenderOptions options_;
    RayBundleSettings settings_;
    AtlasScene surfaces_;
    lights::OtherLights others_;
    AtlasEyeSettings eye_;
    ImageLoop<false> loop_;
    gathering::ExchangeStatistics exchanged_;
};

}  // namespace

std::unique_ptr<Estimator> make_ray_bundle_estimator(const Scene& scene, const RenderOptions& options,
                                                     const RayBundleSettings& settings) {
    return std::make_unique<RayBundleEstimator>(scene, options, settings);
}

}  // namespace mote::integrators
