// Imperfect shadow maps of the VPLs of a pass as a visibility: a lookup where there would be a shadow ray.
#include <fmt/format.h>

#include <atomic>

#include "core/parameters/add_type.h"
#include "core/render/cpu_clock.h"
#include "lights/imperfect_shadow_maps/imperfect_visibility.h"
#include "lights/visibility/visibility.h"

namespace mote::lights {

using namespace core;

namespace {

class PreparedImperfect final : public PreparedVisibility {
  public:
    PreparedImperfect(const LitScene& scene, const ImperfectMapSettings& settings, std::uint64_t seed)
        : settings_(settings), points_(sample_surfaces(scene, std::size_t(settings.all_points), seed)) {}

    void begin(const VisibilityPass& pass) override {
        const Stopwatch stopwatch(seconds_);
        maps_.build(points_, pass.vpls, settings_, pass.key, pass.cancelled);
    }
    TileLight gather(std::size_t, const TileGather& g) override {
        ImperfectVisibility visibility(g.context, g.receivers, maps_);
        const TileLight light = g.selector.gather(g.context, g.receivers, g.range, visibility, g.rng);
        lookups_ += visibility.lookups();
        return light;
    }
    void add_statistics(Statistics& statistics) const override {
        statistics.seconds["imperfect_shadow_maps"] = seconds_;
        statistics.values["imperfect_shadow_map_bytes"] = double(maps_.memory_bytes());
        statistics.lookups["imperfect_shadow_maps"] += lookups_.load();
    }

  private:
    ImperfectMapSettings settings_;
    SurfaceSamples points_;
    ImperfectShadowMaps maps_;  ///< of this pass, from these points
    std::atomic<std::uint64_t> lookups_{0};
    double seconds_ = 0.0;
};

class ImperfectMaps final : public Visibility {
  public:
    explicit ImperfectMaps(const ImperfectMapSettings& settings) : settings_(settings) {}
    std::unique_ptr<PreparedVisibility> prepare(const LitScene& scene, std::uint64_t seed,
                                                const MemoryBudget& memory) const override {
        ImperfectMapSettings settings = settings_;
        settings.memory = memory;
        return std::make_unique<PreparedImperfect>(scene, settings, seed);
    }
    void declare(GatherOptions& options) const override { options.imperfect_shadow_maps = true; }
    void plan(Plan& plan, const LitScene&, double) const override {
        const auto megabytes = [](std::size_t bytes) {
            return fmt::format("{:.2f} MB", double(bytes) * 1e-6);
        };
        plan.run("visibility",
                 fmt::format("imperfect shadow maps of {}^2 texels, {} of {} points in each, biased",
                             settings_.size, settings_.points, settings_.all_points),
                 "requested; traced is exact");
        plan.run("memory of shadow maps",
                 fmt::format("{} for 1000 VPLs, {} of points", megabytes(1000 * settings_.bytes()),
                             megabytes(std::size_t(settings_.all_points) * sizeof(SurfaceSample))),
                 "all maps of a pass are kept");
        plan.miss("detail of shadows", "finer than a texel or a disc around a point",
                  "maps are made of points: what is smaller casts no shadow, and edges are swollen");
    }

  private:
    ImperfectMapSettings settings_;
};

const ParameterList<ImperfectMapSettings>& imperfect_rows() {
    using Map = ImperfectMapSettings;
    static const ParameterList<Map> list{
        row("size", &Map::size, between(2, 1024), "Texels along an edge of a VPL's map."),
        row("points", &Map::points, between(1, 1 << 24), "Points in each map."),
        row("all_points", &Map::all_points, between(1, 1 << 26),
            "Points on all surfaces, at least as many as in a map; each map has a range of them."),
        row("splat", &Map::splat, between(0, 1000), "How often the discs of a map's points cover a surface."),
        row("pull_push", &Map::pull_push, "Fill holes and close gaps between the points."),
        row("bias", &Map::bias, at_least(0, "texels"),
            "Anything nearer by less than the width of so many texels casts no shadow.")};
    return list;
}

std::shared_ptr<Visibility> make_imperfect_maps(ImperfectMapSettings map, const Properties& p) {
    if (p.has("all_points") && map.all_points < map.points)
        throw InputError(fmt::format("'all_points' is {} but must be at least {}, the points of a map",
                                     map.all_points, map.points),
                         p.where_of("all_points"));
    map.all_points = std::max(map.all_points, map.points);
    if (!(map.bias <= float(map.size) - 1.0f))
        throw InputError(fmt::format("'bias' is {} but must be at most {}, the texels of a map less one",
                                     map.bias, map.size - 1),
                         p.where_of("bias"));
    return std::make_shared<ImperfectMaps>(map);
}

}  // namespace

void register_imperfect_visibility(Registry& registry) {
    add_type(
        registry, Category::visibility, "imperfect_shadow_map",
        "Small shadow maps of VPLs, made of points of the surfaces: fast for many receivers, and biased.",
        imperfect_rows(),
        R"(<visibility type="imperfect_shadow_map"><integer name="points" value="4096"/></visibility>)",
        make_imperfect_maps);
}

}  // namespace mote::lights
