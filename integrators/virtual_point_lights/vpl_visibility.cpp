#include "integrators/virtual_point_lights/vpl_visibility.h"

#include <fmt/format.h>

#include "core/objects/properties.h"
#include "lights/shadow_maps/light_shadow_maps.h"
#include "lights/shadow_maps/shadow_map_gather.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Building a texel takes as long as tracing so many receivers (docs/media.md).
constexpr double receivers_per_texel = 5.0;

std::shared_ptr<Object> make_shadow_map(const Properties& p) {
    VisibilitySettings s;
    s.shadow_maps = true;
    s.size = int(p.get_int_in("size", s.size, 4, 8192));
    s.light_size = int(p.get_int_in("light_size", s.light_size, 0, 8192));
    s.maps = int(p.get_int_in("maps", s.maps, 1, 1024));
    s.map.intervals = int(p.get_int_in("intervals", s.map.intervals, 1, 4096));
    s.map.step = float(p.get_float_in("step", 1.0, 1e-3, 1e3));
    s.map.max_bytes = std::size_t(1e6 * p.get_float_in("max_megabytes", 64.0, 1e-6, 1e6));
    s.where = p.has("size") ? p.where_of("size") : p.where;
    return std::make_shared<Visibility>(s);
}

std::shared_ptr<Object> make_imperfect(const Properties& p) {
    VisibilitySettings s;
    lights::ImperfectMapSettings& map = s.imperfect_map;
    s.imperfect = true;
    map.size = int(p.get_int_in("size", map.size, 2, 1024));
    map.points = int(p.get_int_in("points", map.points, 1, 1 << 24));
    map.all_points =
        int(p.get_int_in("all_points", std::max(map.all_points, map.points), map.points, 1 << 26));
    map.splat = float(p.get_float_in("splat", double(map.splat), 0.0, 1000.0));
    map.pull_push = p.get_bool("pull_push", true);
    map.bias = float(p.get_float_in("bias", double(map.bias), 0.0, double(map.size) - 1.0));
    s.where = p.where;
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
                 "asked for; traced is exact");
        plan.run("memory of shadow maps",
                 fmt::format("{} for 1000 VPLs, {} of points", megabytes(1000 * map.bytes()),
                             megabytes(std::size_t(map.all_points) * sizeof(lights::SurfacePoint))),
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
             "asked for; traced is exact");
    plan.run("memory of shadow maps",
             fmt::format("{} of {}, whatever the number of VPLs{}", s.maps, megabytes(bytes),
                         bytes > s.map.max_bytes ? "; refused: above max_megabytes" : ""),
             fmt::format("receivers take about {} more",
                         megabytes(std::size_t(receivers / 16.0 * sizeof(lights::ReceiverStore::Tile)))));
    plan.run("cost of shadow maps",
             fmt::format("{:.0f} receivers a pass against {:.0f} texels a map", receivers, texels),
             receivers > even
                 ? fmt::format("they pay from about {:.0f} receivers on", even)
                 : fmt::format("tracing is cheaper here: they pay from about {:.0f} receivers on, "
                               "or at {}^2",
                               even, int(std::sqrt(receivers / receivers_per_texel))));
    plan_lights(plan, scene, s, chromatic);
    plan.miss("detail of shadows", "finer than the texels of shadow maps",
              "maps interpolate: shadows are blurred, and the mean is biased");
}

void register_visibility(Registry& registry) {
    registry.add({Category::visibility,
                  "traced",
                  "Shadow rays, and tracking through media: exact.",
                  {},
                  R"(<visibility type="traced"/>)"},
                 [](const Properties&) { return std::make_shared<Visibility>(VisibilitySettings{}); });
    registry.add(
        {Category::visibility,
         "imperfect_shadow_map",
         "Small shadow maps of VPLs, made of points of the surfaces: fast for many receivers, and biased.",
         {{"size", "integer", "32", "texels along an edge of a VPL's map"},
          {"points", "integer", "8192", "in each map"},
          {"all_points", "integer", "131072, at least points",
           "on all surfaces; each map has a range of them"},
          {"splat", "float", "4", "how often the discs of a map's points cover a surface"},
          {"pull_push", "boolean", "true", "fill holes and close gaps between the points"},
          {"bias", "float", "0.5", "what is nearer by less than so many texels' width casts no shadow"}},
         R"(<visibility type="imperfect_shadow_map"><integer name="points" value="4096"/></visibility>)"},
        make_imperfect);
    registry.add(
        {Category::visibility,
         "shadow_map",
         "Volumetric shadow maps of VPLs and lights: fast for many receivers, and biased. Only in scenes "
         "with "
         "media.",
         {{"size", "integer", "64", "texels along an edge of a VPL's map"},
          {"light_size", "integer", "256",
           "the same for the maps of point, spot and directional lights, at vertices in media; 0: traced"},
          {"intervals", "integer", "35", "along a ray"},
          {"step", "float", "1", "of ray marching, in voxels"},
          {"max_megabytes", "float", "64", "of one map; a larger one is refused"},
          {"maps", "integer", "4", "kept at once, whatever the number of VPLs"}},
         R"(<visibility type="shadow_map"><integer name="size" value="32"/></visibility>)"},
        make_shadow_map);
}

}  // namespace mote::integrators
