// mote_surroundings: what is seen from the origin of a scene, as directional maps, for a figure of Engelhardt
// 2013, Ch. 7. CSV goes to stdout.
//
//   mote_surroundings time SCENE      what depth maps of about equal pixel count cost, in the layouts of
//   Table 7.1 mote_surroundings reflect SCENE   a sphere that mirrors them, blurred by summed areas, and by
//   lobes (Fig. 7.6)
//
// Exit codes as the mote command's: 0, 1 (the input is at fault), 2 (usage), 3 (ours).

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>

#include "core/formats/xml/scene_loader.h"
#include "core/objects/error.h"
#include "lights/register_lights.h"
#include "media/register_media.h"
#include "tools/directional_maps/directional_map.h"
#include "tools/directional_maps/summed_area_octahedral.h"

namespace {

using namespace mote;
using namespace mote::lights;
using namespace mote::tools;
using core::Rgb;
using core::Vec3;

struct Options {
    std::string scene;
    int size = 512, repeat = 5, pixels = 120;
    std::vector<float> reach{1.0f, 8.0f, 32.0f};
};

/// Scenes have y up, maps z.
Vec3 to_scene(const Vec3& d) { return {d.x, d.z, -d.y}; }

std::optional<core::SurfaceHit> hit_along(const core::Scene& scene, const Vec3& d) {
    core::Ray ray;
    ray.direction = to_scene(d);
    return scene.rays().closest(ray);
}

/// Processor time of `work` [s]: other processes on the machine matter less.
double seconds(const std::function<void()>& work) {
    const std::clock_t start = std::clock();
    work();
    return double(std::clock() - start) / CLOCKS_PER_SEC;
}
double min_seconds(int repeat, const std::function<void()>& work) {
    double least = core::infinity;
    for (int k = 0; k < repeat; ++k) least = std::min(least, seconds(work));
    return least;
}

struct Layout {
    MapKind kind;
    const char* name;
    int size;
    double directions = core::infinity, whole = core::infinity;  ///< least seconds
};

/// On one thread, the layouts in turns, so that none has the quiet minutes to itself.
void time_layouts(const core::Scene& scene, const Options& o) {
    std::vector<Layout> layouts{
        {MapKind::octahedral, "square", o.size},
        {MapKind::octahedral_rectangle, "rectangle", int(std::lround(o.size / std::sqrt(2.0)))},
        {MapKind::cube, "cube", int(std::lround(o.size / std::sqrt(6.0)))}};
    for (int turn = 0; turn < o.repeat; ++turn)
        for (Layout& l : layouts) {
            const auto map = make_directional_map(l.kind, l.size);
            std::vector<float> depth(std::size_t(map->texels()));
            const auto fill = [&](const auto& value) {
                for (int t = 0; t < map->texels(); ++t) depth[std::size_t(t)] = value(map->direction(t));
            };
            l.directions = std::min(l.directions, seconds([&] { fill([](const Vec3& d) { return d.z; }); }));
            l.whole = std::min(l.whole, seconds([&] {
                                   fill([&](const Vec3& d) {
                                       const auto hit = hit_along(scene, d);
                                       return hit ? hit->t : core::infinity;
                                   });
                               }));
        }
    std::puts("layout,size,texels,directions_seconds,seconds");
    for (const Layout& l : layouts)
        std::printf("%s,%d,%d,%.6g,%.6g\n", l.name, l.size, make_directional_map(l.kind, l.size)->texels(),
                    l.directions, l.whole);
}

/// A test scene: Lambertian under a distant sun on a floor of tiles, and a sky.
Rgb radiance(const core::Scene& scene, const Vec3& d) {
    const Vec3 sun = glm::normalize(Vec3(0.5f, 0.8f, 0.6f)), direction = to_scene(d);
    const auto hit = hit_along(scene, d);
    if (!hit) {
        if (glm::dot(direction, sun) > std::cos(0.06f)) return {40.0f, 36.0f, 28.0f};
        return glm::mix(Rgb(0.9f, 0.85f, 0.8f), Rgb(0.25f, 0.45f, 0.9f), std::fabs(direction.y));
    }
    const Vec3 tile = glm::floor(1.5f * hit->position);
    const bool dark = hit->geometric_normal.y > 0.999f && std::fmod(std::fabs(tile.x + tile.z), 2.0f) == 1.0f;
    const float lit = 0.25f + 0.75f * std::fmax(glm::dot(hit->shading.n, sun), 0.0f);
    return lit * (dark ? Rgb(0.25f, 0.12f, 0.08f) : Rgb(0.8f, 0.75f, 0.65f));
}

/// The mean over the cone of this solid angle around d, texel by texel.
Rgb cone_mean(OctahedralMap map, const std::vector<Vec3>& directions, const std::vector<double>& angles,
              const std::vector<Rgb>& values, const Vec3& d, float solid_angle) {
    const float least = 1.0f - solid_angle * core::inv_two_pi;
    core::Vec3d sum(0.0);
    double weights = 0.0;
    for (std::size_t t = 0; t < std::size_t(map.texels()); ++t) {
        if (glm::dot(directions[t], d) < least) continue;
        sum += angles[t] * core::Vec3d(values[t]);
        weights += angles[t];
    }
    return weights > 0.0 ? Rgb(sum / weights) : values[std::size_t(map.texel(d))];
}

struct Pixel {
    int column, row;
    Vec3 direction;
    SummedAreaOctahedral::Mean box{};
    Rgb cone{};
};

/// A mirror sphere seen from afar, from the side, z up.
std::vector<Pixel> mirror_sphere(int pixels) {
    std::vector<Pixel> result;
    for (int row = 0; row < pixels; ++row)
        for (int column = 0; column < pixels; ++column) {
            const float x = (2.0f * float(column) + 1.0f) / float(pixels) - 1.0f;
            const float z = 1.0f - (2.0f * float(row) + 1.0f) / float(pixels);
            if (x * x + z * z >= 1.0f) continue;
            const Vec3 n(x, -std::sqrt(1.0f - x * x - z * z), z), view(0, 1, 0);
            result.push_back({column, row, view - 2.0f * glm::dot(view, n) * n});
        }
    return result;
}

void reflect(const core::Scene& scene, const Options& o) {
    const OctahedralMap map{o.size};
    const auto exact = make_directional_map(MapKind::octahedral, o.size);
    std::vector<Vec3> directions;
    std::vector<double> angles;
    std::vector<Rgb> values;
    for (int t = 0; t < map.texels(); ++t) {
        directions.push_back(map.direction(t));
        angles.push_back(exact->solid_angle(t));
        values.push_back(radiance(scene, directions.back()));
    }
    std::optional<SummedAreaOctahedral> sums;
    const double build = min_seconds(o.repeat, [&] { sums.emplace(map, values); });

    std::vector<Pixel> picture = mirror_sphere(o.pixels);
    std::puts(
        "reach,column,row,solid_angle,r,g,b,cone_r,cone_g,cone_b,build_seconds,box_seconds,cone_seconds");
    for (const float reach : o.reach) {
        const double box_time = min_seconds(o.repeat, [&] {
            for (Pixel& p : picture) p.box = sums->mean(p.direction, reach);
        });
        const double cone_time = seconds([&] {
            for (Pixel& p : picture)
                p.cone = cone_mean(map, directions, angles, values, p.direction, p.box.solid_angle);
        });
        const double count = double(picture.size());
        for (const Pixel& p : picture)
            std::printf("%g,%d,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.3g,%.3g\n", double(reach),
                        p.column, p.row, double(p.box.solid_angle), double(p.box.value.x),
                        double(p.box.value.y), double(p.box.value.z), double(p.cone.x), double(p.cone.y),
                        double(p.cone.z), build, box_time / count, cone_time / count);
    }
}

}  // namespace

int main(int argc, char* argv[]) {
    CLI::App app("mote_surroundings: what is seen from the origin of a scene, in directional maps");
    Options o;
    app.require_subcommand(1);
    CLI::App* timing = app.add_subcommand("time", "the cost of depth maps in three layouts");
    CLI::App* mirror = app.add_subcommand("reflect", "a sphere that mirrors the surroundings, blurred");
    for (CLI::App* command : {timing, mirror}) {
        command->add_option("scene", o.scene)->required();
        command->add_option("--size", o.size)->check(CLI::Range(4, 4096))->capture_default_str();
        command->add_option("--repeat", o.repeat)->check(CLI::Range(1, 1000))->capture_default_str();
    }
    mirror->add_option("--pixels", o.pixels)->check(CLI::Range(1, 4096))->capture_default_str();
    mirror->add_option("--reach", o.reach, "half the width of the boxes, in texels")->delimiter(',');
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    try {
        core::Registry registry;
        core::register_core(registry);
        media::register_media(registry);
        lights::register_lights(registry);
        const auto scene = core::load_scene(o.scene, registry);
        timing->parsed() ? time_layouts(*scene, o) : reflect(*scene, o);
        return 0;
    } catch (const core::InputError& e) {
        std::cerr << "mote_surroundings: " << e.what() << "\n";
        return 1;
    } catch (const std::exception& e) {
        std::cerr << "mote_surroundings: internal error: " << e.what() << "\n";
        return 3;
    }
}
