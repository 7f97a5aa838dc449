// Lookups in imperfect shadow maps against shadow rays, for the very pairs of a gather: VPLs in the room of
// half a million triangles, and tiles of 4x4 neighbouring pixels. The label states in how many pairs the
// answers differ, and what a map takes to build in shadow rays.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include "core/scene/scattering_vertex.h"
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/turns.h"
#include "lights/imperfect_shadow_maps/imperfect_visibility.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::benchmarks {
namespace {

using namespace core;
using namespace lights;

constexpr int picture = 256, spacing = 32, side = 4;

/// Receivers, and the queries of a gather about them: packets of sixteen rays to one VPL.
struct Pairs {
    std::unique_ptr<Scene> scene = make_room("path", picture, picture, false);
    VplSet vpls = trace_light_paths(*scene, {.paths = 128}, 1, 0, SamplerKind::sobol);
    std::vector<ReceiverTile> tiles;
    std::vector<ShadowPacket> packets;
    std::vector<LaneLight> light;

    Pairs() {
        for (int y = spacing / 2; y < picture; y += spacing)
            for (int x = spacing / 2; x < picture; x += spacing) add_tile(x, y);
        const UnboundedGeometry weight;
        for (const ReceiverTile& tile : tiles)
            for (std::size_t j = 0; j < vpls.lights.size(); ++j) {
                ShadowPacket packet;
                LaneLight l;
                packet.clear();
                if (!contributions_of(vpls, {j}, tile, weight, packet, l)) continue;
                packets.push_back(packet), light.push_back(l);
            }
    }
    void add_tile(int x0, int y0) {
        ReceiverTile tile;
        tile.clear();
        for (int lane = 0; lane < ReceiverTile::width; ++lane) {
            const Vec2 at(float(x0 + lane % side) + 0.5f, float(y0 + lane / side) + 0.5f);
            const Ray ray = scene->camera().sample_ray(at, Vec2(0.5f));
            const auto hit = scene->rays().closest(ray);
            if (!hit) continue;
            WalkEvent event;
            event.kind = WalkEvent::Kind::surface, event.distance = hit->t, event.hit = *hit;
            tile.set(lane, make_vertex(event, ray), Rgb(1.0f), MediumState{}, Rng(std::uint64_t(lane)),
                     1 << 30);
        }
        tiles.push_back(tile);
    }
};

void imperfect_lookups_against_rays(benchmark::State& state) {
    Pairs pairs;
    ImperfectShadowMaps maps;
    const ImperfectMapSettings settings{.size = int(state.range(0))};
    const SurfaceSamples points = sample_surfaces(*pairs.scene, std::size_t(settings.all_points), 1);
    const double build = seconds_of([&] {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        maps.build(points, pairs.vpls, settings, 1);
    });
    alignas(64) float visible[ReceiverLanes::width];
    float sink = 0.0f;
    std::vector<ShadowPacket> traced;
    double rays = 0.0, different = 0.0;
    const auto trace = [&] {
        traced = pairs.packets;
        return seconds_of([&] {
            constexpr std::size_t batch = GatherScratch::batch;
            for (std::size_t i = 0; i < traced.size(); i += batch)
                pairs.scene->find_occluded(std::span(traced).subspan(i, std::min(batch, traced.size() - i)));
        });
    };
    const double seconds = trace();
    for (std::size_t i = 0; i < pairs.packets.size(); ++i) {
        maps.look_up(pairs.light[i].vpl, *pairs.light[i].receivers, visible);
        for (int lane = 0; lane < ReceiverLanes::width; ++lane)
            if (pairs.packets[i].t_max[lane] > 0.0f)
                rays += 1.0, different += traced[i].occluded(lane) != (visible[lane] == 0.0f);
    }
    take_turns(
        state, 0.25, rays,
        [&] {
            return seconds_of([&] {
                for (const LaneLight& l : pairs.light)
                    maps.look_up(l.vpl, *l.receivers, visible), sink += visible[3];
            });
        },
        trace);
    benchmark::DoNotOptimize(sink);
    state.SetLabel(fmt::format(
        "{}^2: {:.1f} % of the answers differ; a map takes {:.0f} rays to build, {:.2f} MB a 1000",
        settings.size, 100.0 * different / rays, build / double(maps.count()) / (seconds / rays),
        1e-3 * double(settings.bytes())));
}
BENCHMARK(imperfect_lookups_against_rays)->Arg(16)->Arg(32)->Arg(64)->UseManualTime()->Iterations(15);

}  // namespace
}  // namespace mote::benchmarks
