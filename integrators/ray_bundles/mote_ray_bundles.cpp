// `mote_ray_bundles`: light exchanged between all surfaces at once along global directions (Hermes 2010).
//
// Surfaces are an atlas of texels. Every pass exchanges radiance along the bundles of its own directions
// (gathering/radiance_exchange) and then views the atlas from the eye. The mean over passes converges to
// the picture of the atlas: biased by the size of texels, and by the long paths that the first batches of
// directions lack.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/objects/error.h"
#include "integrators/eye_path/counters.h"
#include "integrators/eye_path/few_reflections.h"
#include "integrators/ray_bundles/atlas_eye_path.h"
#include "integrators/ray_bundles/ray_bundle_settings.h"
#include "integrators/register_parts.h"
#include "lights/emitters/other_lights.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Lights sampled for a texel: its noise is averaged by all directions that the texel sends to.
constexpr int light_samples = 4;

/// Lights that rays of a bundle meet, or that no surface can sample.
std::vector<const Emitter*> lights_of_bundles(const Scene& scene) {
    std::vector<const Emitter*> result;
    for (const auto& emitter : scene.emitters())
        if (emitter->traits().can_be_hit() || emitter->traits().kind == EmitterKind::medium)
            result.push_back(emitter.get());
    return result;
}

/// An exchange keeps, besides texels, received light of every direction of a batch.
gathering::AtlasSettings atlas_settings(const RayBundleSettings& settings, const MemoryBudget& memory) {
    gathering::AtlasSettings atlas = settings.atlas;
    atlas.memory = memory;
    atlas.bytes_per_texel =
        std::size_t(settings.exchange.batch) * sizeof(gathering::Rgb4) * (settings.exchange.lights ? 2 : 1);
    return atlas;
}

/// Refuses scenes one shape of which takes all texels: rays of a bundle are a texel apart, and miss what is
/// smaller.
void require_resolved(const gathering::SurfaceAtlas& atlas) {
    constexpr double min_texels = 1e-3;  ///< of all other shapes together
    std::map<std::uint32_t, double> areas;
    for (const gathering::AtlasTexel& texel : atlas.texels())
        areas[atlas.surfaces().shape[texel.triangle]] += double(texel.area);
    double sum = 0.0, largest = 0.0;
    for (const auto& [shape, area] : areas) sum += area, largest = std::max(largest, area);
    double others = 0.0;  // not sum - largest, which rounds
    for (const auto& [shape, area] : areas) others += area < largest ? area : 0.0;
    const double edge = 1.0 / double(atlas.texels_per_metre());
    if (others > 0.0 && others < min_texels * edge * edge)
        throw InputError(
            fmt::format("mote_ray_bundles: a shape of {:.2g} m^2 takes all texels, which are {:.2g} m wide; "
                        "the others, {:.2g} "
                        "m^2 together, would be missed by all rays: leave it out, or use another integrator",
                        largest, edge, others));
}

class RayBundleEstimator final : public Estimator {
  public:
    RayBundleEstimator(const Scene& scene, const RenderOptions& options, const RayBundleSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          surfaces_(gathering::surface_triangles(
              scene.shapes(), {.memory_budget = options.memory.at_most(std::size_t(4) << 30)})),
          atlas_(surfaces_, scene.shapes(), atlas_settings(settings, options.memory)),
          materials_(gathering::texel_materials(atlas_)),
          locator_(surfaces_),
          tracer_(surfaces_),
          others_(scene, lights_of_bundles(scene)) {
        require_resolved(atlas_);
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
        const AtlasView view(atlas_, locator_, light, sampled);
        return for_each_tile(options_.width, options_.height, 16, context.cancelled,
                             [&](int x0, int y0, int x1, int y1) {
                                 WalkContext walk;
                                 walk.cancelled = context.cancelled;
                                 for (int y = y0; y < y1; ++y)
                                     for (int x = x0; x < x1; ++x) {
                                         if (context.cancelled) return;
                                         store(look(context, view, walk, x, y), image, x, y, false);
                                     }
                                 counters_.add(walk.rays, walk.tracking);
                             });
    }

    void add_statistics(Statistics& statistics) const override {
        counters_.report(statistics, false);
        statistics.values["texels"] = double(atlas_.size());
        statistics.values["texels_per_metre"] = double(atlas_.texels_per_metre());
        statistics.values["charts"] = double(atlas_.charts());
        statistics.values["atlas_bytes"] = double(atlas_.memory_bytes());
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
        return gathering::texel_direct_light(lights, atlas_, materials_, light_samples, key, cancelled);
    }

    gathering::ArrivingLight exchange(const gathering::TexelDirectLight& sampled, std::uint64_t key,
                                      CancelToken cancelled) {
        if (!wants_surfaces()) {
            const std::vector<Rgb> dark(atlas_.size());
            return {dark, dark};
        }
        const gathering::ExchangeScene scene{atlas_, materials_, tracer_, scene_.environment()};
        return exchange_light(scene, settings_.exchange, sampled, key, cancelled, exchanged_);
    }

    /// The mean over the pixel's eye paths of a pass, which are numbered on from pass to pass.
    TransportSum look(const PassContext& context, const AtlasView& view, WalkContext& walk, int x,
                      int y) const {
        AtlasEyePath path(scene_, eye_, view, walk);
        TransportSum sum;
        const auto n = std::uint32_t(settings_.eye_samples);
        for (std::uint32_t k = 0; k < n; ++k) {
            const PassContext sample{context.index * n + k, context.filter, context.cancelled, context.part};
            const EyeRay eye = make_eye_ray(scene_, options_, sample, x, y);
            walk.rng = eye.rng;
            const TransportSum one = path.trace(eye);
            for (std::size_t i = 0; i < transport_count; ++i) sum.light[i] += one.light[i] / float(n);
        }
        return sum;
    }

    const Scene& scene_;
    RenderOptions options_;
    RayBundleSettings settings_;
    gathering::SurfaceTriangles surfaces_;
    gathering::SurfaceAtlas atlas_;
    gathering::TexelMaterials materials_;
    gathering::SurfaceLocator locator_;
    gathering::BundleTracer tracer_;
    lights::OtherLights others_;
    AtlasEyeSettings eye_;
    SharedCounters counters_;
    gathering::ExchangeStatistics exchanged_;
};

class MoteRayBundles final : public Integrator {
  public:
    explicit MoteRayBundles(const RayBundleSettings& settings) : settings_(settings) {}

    std::string type() const override { return "mote_ray_bundles"; }
    std::vector<Layer> layers(const Scene&) const override { return transport_layers(false); }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        require(scene);
        return std::make_unique<RayBundleEstimator>(scene, options, settings_);
    }

  private:
    /// Throws InputError where a pass follows too few reflections.
    void require(const Scene& scene) const {
        const gathering::ExchangeSettings& e = settings_.exchange;
        const bool interleaved = e.transfer == gathering::LightTransfer::interleaved;
        require_reflections(scene, int(interleaved ? e.directions / e.batch : e.bounces), type(),
                            fmt::format("more {} follow more; path and mote_bdpt follow them all",
                                        interleaved ? "directions" : "bounces"));
    }
    void plan_missing(Plan& plan, const Scene& scene, const Requirements& r) const;
    RayBundleSettings settings_;
};

Plan MoteRayBundles::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    const gathering::ExchangeSettings& e = settings_.exchange;
    const bool interleaved = e.transfer == gathering::LightTransfer::interleaved;
    plan.run("surfaces",
             settings_.atlas.texels_per_metre > 0.0f
                 ? fmt::format("an atlas of {:.4g} texels per metre", settings_.atlas.texels_per_metre)
                 : fmt::format("an atlas of {} texels at most", settings_.atlas.texel_budget),
             "light is even over a texel: details of light and shadow smaller than that are blurred");
    plan.run("directions", fmt::format("{} a pass, exchanged after every {}", e.directions, e.batch),
             "fresh ones every pass; a direction serves all surfaces and both ways");
    plan.run(
        "bounces", interleaved ? "all at once" : fmt::format("one at a time, {} of them", e.bounces),
        interleaved
            ? fmt::format("what a batch of directions received is sent by the next: light of more than {} "
                          "reflections is missing",
                          e.directions / e.batch)
            : "transfer is 'one_bounce'");
    const bool hit = r.lights_area + r.lights_infinite > 0;
    if (hit)
        plan.run("area lights and environment", e.lights ? "by bundles" : "sampled at texels and pixels",
                 e.lights ? "direct is 'bundles'" : "direct is 'lights'");
    if (r.lights_point > 0)
        plan.run("lights with a position", fmt::format("{} samples a texel, one a pixel", light_samples),
                 "no ray of a bundle meets them");
    plan.run("view", "the atlas", "on diffuse surfaces; paths scatter on from all others");
    plan_choice_of_lights(plan, scene);
    plan_missing(plan, scene, r);
    try {
        require(scene);
    } catch (const InputError& error) {
        plan.miss("the whole picture", "refused", error.what());
    }
    return plan;
}

void MoteRayBundles::plan_missing(Plan& plan, const Scene& scene, const Requirements& r) const {
    if (r.any_media())
        plan.miss("media", "left out",
                  "links between surfaces and eye paths go through them as through vacuum");
    if (r.any_delta())
        plan.miss("mirrors and glass", "black in the exchange",
                  "light that they pass on between surfaces is missing; eye paths follow them");
    if (scene.has_panes())
        plan.miss("panes and masks", "left out of the exchange",
                  "links pass them unhindered, and what they reflect to other surfaces is missing");
    const bool interleaved = settings_.exchange.transfer == gathering::LightTransfer::interleaved;
    if (r.any_glossy() && !(settings_.exchange.glossy && interleaved))
        plan.miss("glossy surfaces", "reflect towards the eye alone",
                  interleaved ? "glossy_transfer is false" : "transfer is 'one_bounce'");
    if (!interleaved)
        plan.miss("long paths", fmt::format("light of more than {} reflections", settings_.exchange.bounces),
                  "transfer is 'one_bounce'");
}

}  // namespace

void register_mote_ray_bundles(Registry& registry) {
    add_type(
        registry, Category::integrator, "mote_ray_bundles",
        "Global ray-bundles: light is exchanged between all surfaces along parallel rays, and seen as an "
        "atlas holds it. For diffuse surfaces without media.",
        ray_bundle_parameters(),
        R"(<integrator type="mote_ray_bundles"><integer name="directions" value="512"/></integrator>)",
        [](const RayBundleSettings& s) { return std::make_shared<MoteRayBundles>(s); });
}

}  // namespace mote::integrators
