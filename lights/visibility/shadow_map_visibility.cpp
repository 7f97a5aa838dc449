// Volumetric shadow maps of VPLs and lights as a visibility: receivers are stored first, and all VPLs then
// add their light to them by their maps (mapped_visibility.h).
#include <fmt/format.h>

#include "core/parameters/add_type.h"
#include "lights/shadow_maps/shadow_map_gather.h"
#include "lights/visibility/mapped_visibility.h"

namespace mote::lights {

using namespace core;

namespace {

/// Building a texel takes as long as tracing so many receivers (docs/methods/shadow_maps.md).
constexpr double receivers_per_texel = 5.0;

/// Settings with what only scene files give.
struct ShadowMapFile : MappedVisibilitySettings {
    double max_megabytes = 64.0;
};

const ParameterList<ShadowMapFile>& shadow_map_rows() {
    using S = ShadowMapFile;
    using Map = ShadowMapSettings;
    static const ParameterList<S> list{
        row("size", &S::size, between(4, 8192), "Texels along an edge of a VPL's map."),
        within(&S::lights,
               row("light_size", &LightMapSettings::size, between(0, 8192),
                   "Texels along an edge of the maps of point, spot and directional lights, at vertices in "
                   "media; "
                   "0: traced."),
               within(&LightMapSettings::map,
                      row("intervals", &Map::intervals, between(1, 4096), "Intervals along a ray."),
                      row("step", &Map::step, between(1e-3, 1e3, "voxels"), "Step of ray marching."))),
        row("max_megabytes", &S::max_megabytes, between(1e-6, 1e6, "MB"),
            "Memory of one map; a larger one is refused."),
        row("maps", &S::maps, between(1, 1024), "Maps kept at once, whatever the number of VPLs.")};
    return list;
}

std::string megabytes(std::size_t bytes) { return fmt::format("{:.2f} MB", double(bytes) * 1e-6); }

std::size_t mapped_lights(const LitScene& scene) {
    std::size_t count = 0;
    for (const auto& emitter : scene.emitters()) count += shadow_map_view_of(scene, *emitter, 1).has_value();
    return count;
}

void plan_lights(Plan& plan, const LitScene& scene, const MappedVisibilitySettings& s, bool chromatic) {
    const std::size_t count = s.lights.size > 0 ? mapped_lights(scene) : 0;
    if (count == 0) {
        plan.run("visibility of lights", "traced",
                 s.lights.size > 0 ? "no light is a point, a cone or parallel" : "light_size is 0");
        return;
    }
    plan.run(
        "visibility of lights",
        fmt::format("{} shadow map(s) of {}^2 for vertices in media, {}", count, s.lights.size,
                    megabytes(count * s.lights.map.bytes(s.lights.size, chromatic))),
        "built once, biased; direct light on surfaces and of lights with an extent or at infinity is traced");
}

/// Surfaces alone are cheaper by shadow rays.
class ShadowMapsWithoutMedia final : public PreparedVisibility {
  public:
    TileLight gather(std::size_t task, const TileGather& g) override { return traced_->gather(task, g); }
    void add_statistics(Statistics& statistics) const override {
        statistics.warnings.push_back("visibility 'shadow_map' has no effect: there are no media");
    }

  private:
    std::unique_ptr<PreparedVisibility> traced_ = prepare_traced_visibility();
};

class ShadowMaps final : public Visibility {
  public:
    explicit ShadowMaps(const MappedVisibilitySettings& settings) : settings_(settings) {}
    std::unique_ptr<PreparedVisibility> prepare(const LitScene& scene, std::uint64_t,
                                                const MemoryBudget& memory) const override {
        if (!scene.has_media()) return std::make_unique<ShadowMapsWithoutMedia>();
        return prepare_mapped_visibility(scene, settings_, memory);
    }
    std::optional<LightMapSettings> light_maps() const override { return settings_.lights; }
    void declare(GatherOptions& options) const override { options.shadow_maps = true; }
    void plan(Plan& plan, const LitScene& scene, double receivers) const override {
        const MappedVisibilitySettings& s = settings_;
        if (!scene.has_media()) {
            plan.run("visibility", "shadow rays, sixteen at a time",
                     "exact; shadow_map has no effect: there are no media, and surfaces alone are cheaper by "
                     "shadow rays");
            return;
        }
        const bool chromatic = needs_chromatic_maps(scene);
        const double texels = double(s.size) * double(s.size), even = receivers_per_texel * texels;
        const std::size_t bytes = s.lights.map.bytes(s.size, chromatic);
        plan.run("visibility",
                 fmt::format("shadow maps of {}^2 texels, {} intervals each, biased", s.size,
                             s.lights.map.intervals),
                 "requested; traced is exact");
        plan.run("memory of shadow maps",
                 fmt::format("{} of {}, whatever the number of VPLs{}", s.maps, megabytes(bytes),
                             bytes > s.lights.map.max_bytes ? "; refused: above max_megabytes" : ""),
                 fmt::format("receivers take about {} more",
                             megabytes(std::size_t(receivers / 16.0 * sizeof(ReceiverStore::Tile)))));
        plan.run(
            "cost of shadow maps",
            fmt::format("{:.0f} receivers a pass against {:.0f} texels a map", receivers, texels),
            receivers > even
                ? fmt::format("they pay from about {:.0f} receivers on", even)
                : fmt::format("tracing is cheaper here: they pay from about {:.0f} receivers on, or at {}^2",
                              even, int(std::sqrt(receivers / receivers_per_texel))));
        plan_lights(plan, scene, s, chromatic);
        plan.miss("detail of shadows", "finer than the texels of shadow maps",
                  "maps interpolate: shadows are blurred, and the mean is biased");
    }

  private:
    MappedVisibilitySettings settings_;
};

}  // namespace

void register_shadow_map_visibility(Registry& registry) {
    add_type(registry, Category::visibility, "shadow_map",
             "Volumetric shadow maps of VPLs and lights: fast for many receivers, and biased. Only in scenes "
             "with media.",
             shadow_map_rows(),
             R"(<visibility type="shadow_map"><integer name="size" value="32"/></visibility>)",
             [](ShadowMapFile s, const Properties& p) {
                 s.lights.map.max_bytes = std::size_t(1e6 * s.max_megabytes);
                 s.lights.where = p.where_of("size");
                 return std::make_shared<ShadowMaps>(s);
             });
}

}  // namespace mote::lights
