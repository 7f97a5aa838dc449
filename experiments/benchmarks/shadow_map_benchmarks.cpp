// One lookup in a volumetric shadow map against tracing the same transmittance as a render does it: shadow
// rays in packets of sixteen, and ratio tracking where they are clear. In the smoke room, from a lamp at its
// ceiling to two sets of points: `camera`, the receivers of 4x4 neighbouring pixels, in smoke and on
// surfaces, as eye paths find them; `random`, points in the smoke in random order, with which no cache can
// help.
//
// The label states the map's error against ray marching in steps of a tenth of a voxel and exact visibility:
// the mean relative error where at least 1 % gets through, its root mean square, and the mean absolute error
// of all points, shadows included, relative to their mean transmittance.
#include <fmt/format.h>

#include <filesystem>

#include "core/formats/xml/scene_loader.h"
#include "core/math/random.h"
#include "core/scene/scattering_vertex.h"
#include "experiments/benchmarks/turns.h"
#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "session/registry.h"

namespace mote::benchmarks {

namespace {

using namespace core;
using lights::ShadowLookup, lights::ShadowMapSettings, lights::ShadowMapView, lights::VolumetricShadowMap;
using Points = std::vector<ShadowLookup>;
constexpr int width = ShadowLookup::width;
static_assert(width == ShadowPacket::width);

const Registry& registry() {
    static const Registry all = session::make_registry();
    return all;
}

/// Points where there is smoke, sampled by density.
Points points_in_smoke(const Medium& smoke, std::size_t packets) {
    Rng rng(4);
    const Bounds3 box = smoke.bounds();
    Points points(packets);
    for (ShadowLookup& packet : points)
        for (int i = 0; i < width;) {
            const Vec3 p =
                box.lower + Vec3(rng.next_float(), rng.next_float(), rng.next_float()) * box.diagonal();
            if (rng.next_float() * smoke.majorant() >= smoke.coefficients(p).sigma_t.x) continue;
            packet.x[i] = p.x, packet.y[i] = p.y, packet.z[i] = p.z, ++i;
        }
    return points;
}

/// The first vertices of eye paths, a tile of 4x4 pixels a packet.
Points points_of_camera(const Scene& scene, int columns, int rows) {
    Points points;
    WalkContext context;
    const FilmSettings& film = scene.film();
    for (int y = 0; y + 4 <= rows; y += 4)
        for (int x = 0; x + 4 <= columns; x += 4) {
            ShadowLookup& packet = points.emplace_back();
            for (int i = 0; i < width; ++i) {
                const Vec2 pixel(float(x + i % 4) + 0.5f, float(y + i / 4) + 0.5f);
                const Ray ray = scene.camera().sample_ray(
                    pixel * Vec2(film.width, film.height) / Vec2(columns, rows), Vec2(0.5f));
                MediumState state = scene.camera_medium_state();
                PathWeights weights;
                Rgb emitted(0.0f);
                const WalkEvent event = core::walk<true>(scene, ray, state, weights, emitted, context);
                const bool outside = event.kind == WalkEvent::Kind::escaped;  // through the window
                const Vec3 p = outside ? ray.at(6.0f) : make_vertex(event, ray).ray_origin(-ray.direction);
                packet.x[i] = p.x, packet.y[i] = p.y, packet.z[i] = p.z;
            }
        }
    return points;
}

/// The lamp, and what it takes to trace from it.
struct Lamp {
    const Scene& scene;
    Vec3 position;
    MediumState state = scene.medium_state_at(position, nullptr);
    std::vector<ShadowPacket> packets = std::vector<ShadowPacket>(32);
    Rng rng{1};
    TrackingCounters counters{};

    /// As TracedVisibility of lights/virtual_lights/vpl_gather.h.
    float trace(const Points& points) {
        float sum = 0.0f;
        for (std::size_t first = 0; first < points.size(); first += packets.size()) {
            const std::size_t count = std::min(packets.size(), points.size() - first);
            for (std::size_t p = 0; p < count; ++p) fill(packets[p], points[first + p]);
            scene.rays().occluded(std::span(packets).first(count));
            for (std::size_t p = 0; p < count; ++p) {
                const ShadowLookup& at = points[first + p];
                for (int i = 0; i < width; ++i)
                    if (!packets[p].occluded(i))
                        sum += scene
                                   .transmittance(Vec3(at.x[i], at.y[i], at.z[i]), position, state, rng,
                                                  counters)
                                   .x;
            }
        }
        return sum;
    }
    void fill(ShadowPacket& packet, const ShadowLookup& at) const {
        packet.clear();
        for (int i = 0; i < width; ++i) {
            packet.origin_x[i] = at.x[i], packet.origin_y[i] = at.y[i], packet.origin_z[i] = at.z[i];
            packet.direction_x[i] = position.x - at.x[i], packet.direction_y[i] = position.y - at.y[i];
            packet.direction_z[i] = position.z - at.z[i];
            packet.t_min[i] = 0.0f, packet.t_max[i] = 0.9999f;
        }
    }
    double exact(const Vec3& p) {
        const Vec3 d = p - position;
        if (scene.rays().occluded(Ray{p, -glm::normalize(d), 0.0f, 0.9999f * glm::length(d)})) return 0.0;
        const Medium& smoke = *scene.media().front();
        const auto part = intersect(smoke.bounds(), Ray{position, glm::normalize(d), 0.0f, glm::length(d)});
        if (!part) return 1.0;
        const Ray inside{position, glm::normalize(d), part->t0, part->t1};
        return std::exp(-smoke.optical_depth_along(inside, 0.1f, counters).x);
    }
};

struct Errors {
    double mean = 0.0, rms = 0.0, absolute = 0.0;
};

Errors errors_of(const VolumetricShadowMap& map, Lamp& lamp, const Points& points) {
    Errors e;
    double light = 0.0;
    int judged = 0;
    for (std::size_t p = 0; p < points.size(); p += std::max<std::size_t>(points.size() / 250, 1)) {
        ShadowLookup at = points[p];
        map.look_up({&at, 1});
        for (int i = 0; i < width; ++i) {
            const double exact = lamp.exact(Vec3(at.x[i], at.y[i], at.z[i]));
            light += exact, e.absolute += std::fabs(double(at.r[i]) - exact);
            if (!(exact > 0.01)) continue;
            const double error = double(at.r[i]) / exact - 1.0;
            e.mean += std::fabs(error), e.rms += error * error, ++judged;
        }
    }
    return {e.mean / judged, std::sqrt(e.rms / judged), e.absolute / light};
}

enum class Order { camera, random };

void shadow_map_lookup(benchmark::State& state, Order order) {
    const std::string file = MOTE_SOURCE_DIR "/scenes/smoke_room.xml";
    if (!std::filesystem::exists(MOTE_SOURCE_DIR "/scenes/generated/smoke.vdb")) {
        state.SkipWithError("no smoke: run scenes/generate");
        return;
    }
    const auto scene = load_scene(file, registry());
    const Medium& smoke = *scene->media().front();
    Lamp lamp{*scene, Vec3(smoke.bounds().center().x, 2.85f, smoke.bounds().center().z)};
    ShadowMapSettings settings;
    settings.intervals = int(state.range(1));
    VolumetricShadowMap map;
    const auto view = ShadowMapView::of_point(lamp.position, int(state.range(0)));
    const double build = seconds_of([&] { map.build(*scene, view, lamp.state, settings); });
    Points points =
        order == Order::camera ? points_of_camera(*scene, 320, 200) : points_in_smoke(smoke, 1250);
    const Errors errors = errors_of(map, lamp, points);

    float sink = 0.0f;
    const auto look_up = [&] {
        return seconds_of([&] { map.look_up(points), sink += points.front().r[0]; });
    };
    take_turns(state, 0.1, double(points.size()) * width, look_up,
               [&] { return seconds_of([&] { sink += lamp.trace(points); }); });
    benchmark::DoNotOptimize(sink);
    state.SetLabel(fmt::format(
        "{}^2: error {:.2f} % mean, {:.1f} % rms, {:.2f} % absolute; {:.1f} MB, {:.0f} ms to build",
        view.size, 100.0 * errors.mean, 100.0 * errors.rms, 100.0 * errors.absolute,
        double(map.memory_bytes()) * 1e-6, 1e3 * build));
}

void Shadow_map_camera(benchmark::State& state) { shadow_map_lookup(state, Order::camera); }
void Shadow_map_random(benchmark::State& state) { shadow_map_lookup(state, Order::random); }

/// Texels along an edge, intervals: 19, 35 and 51 fill 64, 96 and 128 bytes a texel.
void sizes(benchmark::internal::Benchmark* b) {
    for (const int size : {64, 128, 192, 256, 320}) b->Args({size, 35});
    b->Args({256, 19})->Args({256, 51})->UseManualTime()->Iterations(9);
}

}  // namespace

BENCHMARK(Shadow_map_camera)->Apply(sizes);
BENCHMARK(Shadow_map_random)->Apply(sizes);

}  // namespace mote::benchmarks
