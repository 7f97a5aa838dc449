// Cost of queries through an interface: the same rays by RayTracer's own functions and through RayQueries,
// and gathering over the callbacks of another renderer's scene against gathering over a Scene.
#include "core/math/warp.h"
#include "core/scene/callback_scene.h"
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/turns.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::benchmarks {
namespace {

using namespace core;

constexpr double target = 1.03;
constexpr std::size_t ray_count = 1 << 16;

/// Rays from the middle of the room to all sides.
std::vector<Ray> rays_around(const Scene& scene) {
    Rng rng(5);
    std::vector<Ray> rays(ray_count);
    for (Ray& ray : rays)
        ray = {scene.bounds().center(), square_to_sphere({rng.next_float(), rng.next_float()})};
    return rays;
}

std::vector<ShadowPacket> packets_of(const std::vector<Ray>& rays) {
    std::vector<ShadowPacket> packets(rays.size() / ShadowPacket::width);
    for (std::size_t i = 0; i < packets.size() * ShadowPacket::width; ++i) {
        ShadowPacket& p = packets[i / ShadowPacket::width];
        const auto lane = int(i % ShadowPacket::width);
        if (lane == 0) p.clear();
        const Ray& ray = rays[i];
        p.origin_x[lane] = ray.origin.x, p.origin_y[lane] = ray.origin.y, p.origin_z[lane] = ray.origin.z;
        p.direction_x[lane] = ray.direction.x, p.direction_y[lane] = ray.direction.y;
        p.direction_z[lane] = ray.direction.z;
        p.t_min[lane] = 0.0f, p.t_max[lane] = 3.0f;
    }
    return packets;
}

/// A scene of which the compiler sees only the interface.
const RayQueries& hidden(const RayQueries& scene) {
    const RayQueries* pointer = &scene;
    benchmark::DoNotOptimize(pointer);
    return *pointer;
}

void interface_first_hit(benchmark::State& state) {
    const auto scene = make_room("path", 16, 16);
    const auto rays = rays_around(*scene);
    const RayQueries& queries = hidden(*scene);
    const auto trace = [&](const auto& closest) {
        return seconds_of([&] {
            float sum = 0.0f;
            for (const Ray& ray : rays)
                if (const auto hit = closest(ray)) sum += hit->t;
            benchmark::DoNotOptimize(sum);
        });
    };
    take_turns(
        state, target, double(rays.size()),
        [&] { return trace([&](const Ray& ray) { return queries.first_hit(ray); }); },
        [&] { return trace([&](const Ray& ray) { return scene->rays().closest(ray); }); });
}
BENCHMARK(interface_first_hit)->UseManualTime()->Iterations(15)->Unit(benchmark::kMillisecond);

void interface_visible(benchmark::State& state) {
    const auto scene = make_room("path", 16, 16);
    const auto rays = rays_around(*scene);
    const RayQueries& queries = hidden(*scene);
    const auto trace = [&](const auto& visible) {
        return seconds_of([&] {
            std::size_t free = 0;
            for (const Ray& ray : rays) free += visible(ray);
            benchmark::DoNotOptimize(free);
        });
    };
    take_turns(
        state, target, double(rays.size()),
        [&] { return trace([&](const Ray& ray) { return queries.visible(ray); }); },
        [&] { return trace([&](const Ray& ray) { return !scene->rays().occluded(ray); }); });
}
BENCHMARK(interface_visible)->UseManualTime()->Iterations(15)->Unit(benchmark::kMillisecond);

/// Batches as gathering makes them.
void interface_find_occluded(benchmark::State& state) {
    const auto scene = make_room("path", 16, 16);
    const auto all = packets_of(rays_around(*scene));
    const RayQueries& queries = hidden(*scene);
    const auto trace = [&](const auto& occlude) {
        auto packets = all;
        return seconds_of([&] {
            for (std::size_t i = 0; i < packets.size(); i += lights::GatherScratch::batch)
                occlude(std::span(packets).subspan(i, lights::GatherScratch::batch));
        });
    };
    take_turns(
        state, target, double(ray_count),
        [&] { return trace([&](std::span<ShadowPacket> p) { queries.find_occluded(p); }); },
        [&] { return trace([&](std::span<ShadowPacket> p) { scene->rays().occluded(p); }); });
}
BENCHMARK(interface_find_occluded)->UseManualTime()->Iterations(15)->Unit(benchmark::kMillisecond);

/// Gathering over callbacks to the very same tracer.
void gather_over_callbacks(benchmark::State& state) {
    const auto scene = make_room("path", 16, 16, false);
    const CallbackScene foreign(
        {.first_hit = [&](const Ray& ray) { return scene->rays().closest(ray); },
         .find_occluded = [&](std::span<ShadowPacket> packets) { scene->rays().occluded(packets); },
         .bounds = scene->bounds()});
    const auto vpls = lights::trace_light_paths(*scene, {.paths = 256}, 1, 0, SamplerKind::sobol);
    const auto rays = rays_around(*scene);
    std::vector<lights::ReceiverTile> tiles(64);
    std::vector<ScatteringVertex> vertices(tiles.size() * lights::ReceiverLanes::width);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        WalkEvent event;
        const auto hit = scene->first_hit(rays[i]);
        if (!hit || !hit->shape->bsdf->traits().smooth) continue;
        event.kind = WalkEvent::Kind::surface, event.hit = *hit;
        vertices[i] = make_vertex(event, rays[i]);
        tiles[i / lights::ReceiverLanes::width].set(int(i % lights::ReceiverLanes::width), vertices[i],
                                                    Rgb(1.0f), {}, Rng(i), 100);
    }
    const auto scratch = std::make_unique<lights::GatherScratch>();
    const auto gather_all = [&](const RayQueries& over) {
        RayCounters counters;
        TrackingCounters tracking;
        return seconds_of([&] {
            for (auto& tile : tiles)
                benchmark::DoNotOptimize(lights::gather({over, *scratch, counters, tracking}, vpls,
                                                        lights::VplRange{}, lights::BoundedGeometry{10.0f},
                                                        tile));
        });
    };
    take_turns(
        state, target, double(vpls.lights.size() * tiles.size() * 16), [&] { return gather_all(foreign); },
        [&] { return gather_all(*scene); });
}
BENCHMARK(gather_over_callbacks)->UseManualTime()->Iterations(15)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
