#include "integrators/virtual_point_lights/vpl_visibility.h"

#include <fmt/format.h>

#include "lights/shadow_maps/light_shadow_maps.h"
#include "lights/shadow_maps/shadow_map_gather.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Building a texel takes as long as tracing so many receivers (docs/media.md).
constexpr double receivers_per_texel = 5.0;

/// Settings with what only scene files give.
struct ShadowMapFile : VisibilitySettings {
    double max_megabytes = 64.0;
    ShadowMapFile() { shadow_maps = true; }
};

const ParameterList<ShadowMapFile>& shadow_map_rows() {
    using S = ShadowMapFile;
    using Map = lights::ShadowMapSettings;
    static const ParameterList<S> list{
        row("size", &S::size, between(4, 8192), "Texels along an edge of a VPL's map."),
        row("light_size", &S::light_size, between(0, 8192),
            "Texels along an edge of the maps of point, spot and directional lights, at vertices in media; "
            "0: traced."),
        within(&S::map, row("intervals", &Map::intervals, between(1, 4096), "Intervals along a ray."),
               row("step", &Map::step, between(1e-3, 1e3, "voxels"), "Step of ray marching.")),
        row("max_megabytes", &S::max_megabytes, between(1e-6, 1e6, "MB"),
            "Memory of one map; a larger one is refused."),
        row("maps", &S::maps, between(1, 1024), "Maps kept at once, whatever the number of VPLs.")};
    return list;
}

std::shared_ptr<Visibility> make_shadow_map(ShadowMapFile s, const Properties& p) {
    s.map.max_bytes = std::size_t(1e6 * s.max_megabytes);
    s.where = p.where_of("size");
    return std::make_shared<Visibility>(s);
}

const ParameterList<VisibilitySettings>& imperfect_rows() {
    using S = VisibilitySettings;
    using Map = lights::ImperfectMapSettings;
    static const ParameterList<S> list{within(
        &S::imperfect_map, row("size", &Map::size, between(2, 1024), "Texels along an edge of a VPL's map."),
        row("points", &Map::points, between(1, 1 << 24), "Points in each map."),
        row("all_points", &Map::all_points, between(1, 1 << 26),
            "Points on all surfaces, at least as many as in a map; each map has a range of them."),
        row("splat", &Map::splat, between(0, 1000), "How often the discs of a map's points cover a surface."),
        row("pull_push", &Map::pull_push, "Fill holes and close gaps between the points."),
        row("bias", &Map::bias, at_least(0, "texels"),
            "Anything nearer by less than the width of so many texels casts no shadow."))};
    return list;
}

std::shared_ptr<Visibility> make_imperfect(VisibilitySettings s, const Properties& p) {
    lights::ImperfectMapSettings& map = s.imperfect_map;
    s.imperfect = true, s.where = p.where;
    if (p.has("all_points") && map.all_points < map.points)
        throw InputError(fmt::format("'all_points' is {} but must be at least {}, the points of a map",
                                     map.all_points, map.points),
                         p.where_of("all_points"));
    map.all_points = std::max(map.all_points, map.points);
    if (!(map.bias <= float(map.size) - 1.0f))
        throw InputError(fmt::format("'bias' is {} but must be at most {}, the texels of a map less one",
                                     map.bias, map.size - 1),
                         p.where_of("bias"));
    return std::make_shared<Visibility>(s);
}

std::string megabytes(std::size_t bytes) { return fmt::format("{:.2f} MB", double(bytes) * 1e-6); }

std::size_t mapped_lights(const Scene& scene) {
    std::size_t count = 0;
    for (const auto& emitter : scene.emitters())
        count += lights::shadow_map_view_of(scene, *emitter, 1).has_value();
    return count;
}

void plan_lights(Plan& plan, const Scene& scene, const VisibilitySettings& s, bool chromatic) {
    const std::size_t count = s.light_size > 0 ? mapped_lights(scene) : 0;
    if (count == 0) {
        plan.run("visibility of lights", "traced",
                 s.light_size > 0 ? "no light is a point, a cone or parallel" : "light_size is 0");
        return;
    }
    plan.run(
        "visibility of lights",
        fmt::format("{} shadow map(s) of {}^2 for vertices in media, {}", count, s.light_size,
                    megabytes(count * s.map.bytes(s.light_size, chromatic))),
        "built once, biased; direct light on surfaces and of lights with an extent or at infinity is traced");
}

}  // namespace

void VisibilitySettings::check(const Scene& scene) const {
    const bool chromatic = lights::needs_chromatic_maps(scene);
    for (const int edge : {size, light_size}) try {
            if (edge > 0) map.check(edge, chromatic);
        } catch (const InputError& error) {
            throw InputError(error.what(), where);
        }
}

void plan_visibility(Plan& plan, const Scene& scene, const VisibilitySettings& s, double receivers) {
    if (s.imperfect) {
        const lights::ImperfectMapSettings& map = s.imperfect_map;
        plan.run("visibility",
                 fmt::format("imperfect shadow maps of {}^2 texels, {} of {} points in each, biased",
                             map.size, map.points, map.all_points),
                 "requested; traced is exact");
        plan.run("memory of shadow maps",
                 fmt::format("{} for 1000 VPLs, {} of points", megabytes(1000 * map.bytes()),
                             megabytes(std::size_t(map.all_points) * sizeof(lights::SurfaceSample))),
                 "all maps of a pass are kept");
        plan.miss("detail of shadows", "finer than a texel or a disc around a point",
                  "maps are made of points: what is smaller casts no shadow, and edges are swollen");
        return;
    }
    if (!s.used_in(scene)) {
        plan.run("visibility", "shadow rays, sixteen at a time",
                 s.shadow_maps
                     ? "exact; shadow_map has no effect: there are no media, and surfaces alone are "
                       "cheaper by shadow rays"
                     : "exact");
        return;
    }
    const bool chromatic = lights::needs_chromatic_maps(scene);
    const double texels = double(s.size) * double(s.size), even = receivers_per_texel * texels;
    const std::size_t bytes = s.map.bytes(s.size, chromatic);
    plan.run("visibility",
             fmt::format("shadow maps of {}^2 texels, {} intervals each, biased", s.size, s.map.intervals),
             "requested; traced is exact");
    plan.run("memory of shadow maps",
             fmt::format("{} of {}, whatever the number of VPLs{}", s.maps, megabytes(bytes),
                         bytes > s.map.max_bytes ? "; refused: above max_megabytes" : ""),
             fmt::format("receivers take about {} more",
                         megabytes(std::size_t(receivers / 16.0 * sizeof(lights::ReceiverStore::Tile)))));
    plan.run("cost of shadow maps",
             fmt::format("{:.0f} receivers a pass against {:.0f} texels a map", receivers, texels),
             receivers > even
                 ? fmt::format("they pay from about {:.0f} receivers on", even)
                 : fmt::format("tracing is cheaper here: they pay from about {:.0f} receivers on, or at {}^2",
                               even, int(std::sqrt(receivers / receivers_per_texel))));
    plan_lights(plan, scene, s, chromatic);
    plan.miss("detail of shadows", "finer than the texels of shadow maps",
              "maps interpolate: shadows are blurred, and the mean is biased");
}

void register_visibility(Registry& registry) {
    add_type(registry, Category::visibility, "traced", "Shadow rays, and tracking through media: exact.",
             R"(<visibility type="traced"/>)",
             [] { return std::make_shared<Visibility>(VisibilitySettings{}); });
    add_type(
        registry, Category::visibility, "imperfect_shadow_map",
        "Small shadow maps of VPLs, made of points of the surfaces: fast for many receivers, and biased.",
        imperfect_rows(),
        R"(<visibility type="imperfect_shadow_map"><integer name="points" value="4096"/></visibility>)",
        make_imperfect);
    add_type(registry, Category::visibility, "shadow_map",
             "Volumetric shadow maps of VPLs and lights: fast for many receivers, and biased. Only in scenes "
             "with media.",
             shadow_map_rows(),
             R"(<visibility type="shadow_map"><integer name="size" value="32"/></visibility>)",
             make_shadow_map);
}

}  // namespace mote::integrators
