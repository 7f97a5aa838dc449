// One lookup in a volumetric shadow map against tracing the same transmittance: a shadow ray and ratio
// tracking. In the smoke room, from its lamp to points in the smoke. The label tells the map's error and what
// it costs to build.
#include <fmt/format.h>

#include <filesystem>

#include "core/math/random.h"
#include "core/scene/scene_loader.h"
#include "experiments/benchmarks/turns.h"
#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "lights/volumetric_shadow_map.h"
#include "media/register_media.h"

namespace mote::benchmarks {

namespace {

using namespace core;
using lights::ShadowMapSettings, lights::ShadowMapView, lights::VolumetricShadowMap;

const Registry& registry() {
    static const Registry all = [] {
        Registry r;
        register_core(r), media::register_media(r), lights::register_lights(r);
        integrators::register_integrators(r);
        return r;
    }();
    return all;
}

/// Points where there is smoke, drawn by density.
std::vector<Vec3> points_in_smoke(const Medium& smoke, std::size_t count) {
    Rng rng(4);
    std::vector<Vec3> points;
    const Bounds3 box = smoke.bounds();
    while (points.size() < count) {
        const Vec3 p =
            box.lower + Vec3(rng.next_float(), rng.next_float(), rng.next_float()) * box.diagonal();
        if (rng.next_float() * smoke.majorant() < smoke.coefficients(p).sigma_t.x) points.push_back(p);
    }
    return points;
}

/// Mean of many estimates by ratio tracking; 0 behind a surface.
float traced(const Scene& scene, const MediumState& state, const Vec3& from, const Vec3& to, int count,
             Rng& rng, TrackingCounters& counters) {
    const Vec3 d = to - from;
    if (scene.rays().occluded(Ray{from, glm::normalize(d), 0.0f, glm::length(d)})) return 0.0f;
    double sum = 0.0;
    for (int i = 0; i < count; ++i) sum += double(scene.transmittance(from, to, state, rng, counters).x);
    return float(sum / count);
}

void shadow_map_lookup(benchmark::State& state, ShadowMapSettings::Storage storage) {
    const std::string file = MOTE_SOURCE_DIR "/scenes/smoke_room.xml";
    if (!std::filesystem::exists(MOTE_SOURCE_DIR "/scenes/generated/smoke.vdb")) {
        state.SkipWithError("no smoke: run scenes/generate");
        return;
    }
    const auto scene = load_scene(file, registry());
    const Medium& smoke = *scene->media().front();
    const ShadowMapView view = ShadowMapView::of_point(
        Vec3(smoke.bounds().center().x, 2.85f, smoke.bounds().center().z), int(state.range(0)));
    const MediumState at_light = scene->medium_state_at(view.origin, nullptr);
    ShadowMapSettings settings;
    settings.storage = storage;
    VolumetricShadowMap map;
    const double build = seconds_of([&] { map.build(*scene, view, at_light, settings); });
    const auto points = points_in_smoke(smoke, 20000);

    Rng rng(1);
    TrackingCounters counters;
    double squares = 0.0, absolute = 0.0;
    int judged = 0;
    for (std::size_t i = 0; i < 1500; ++i) {
        const float exact = traced(*scene, at_light, view.origin, points[i], 2000, rng, counters);
        if (!(exact > 0.01f)) continue;  // what hardly gets through is noise on both sides
        const double error = double(map.transmittance(points[i]).x) / double(exact) - 1.0;
        squares += error * error, absolute += std::fabs(error), ++judged;
    }
    float sink = 0.0f;
    take_turns(
        state, 0.1, double(points.size()),
        [&] {
            return seconds_of([&] {
                for (const Vec3& p : points) sink += map.transmittance(p).x;
            });
        },
        [&] {
            return seconds_of([&] {
                for (const Vec3& p : points)
                    sink += traced(*scene, at_light, view.origin, p, 1, rng, counters);
            });
        });
    benchmark::DoNotOptimize(sink);
    state.SetLabel(fmt::format(
        "{}^2 x {}: error {:.2f} % mean, {:.2f} % rms; {:.1f} MB, built in {:.0f} ms of one thread",
        view.size, settings.intervals, 100.0 * absolute / judged, 100.0 * std::sqrt(squares / judged),
        double(map.memory_bytes()) * 1e-6, 1e3 * build));
}

void Shadow_map_of_intervals_against_tracing(benchmark::State& state) {
    shadow_map_lookup(state, ShadowMapSettings::Storage::intervals);
}
void Shadow_map_of_nodes_against_tracing(benchmark::State& state) {
    shadow_map_lookup(state, ShadowMapSettings::Storage::nodes);
}

}  // namespace

BENCHMARK(Shadow_map_of_intervals_against_tracing)
    ->Arg(64)
    ->Arg(128)
    ->Arg(256)
    ->UseManualTime()
    ->Iterations(9);
BENCHMARK(Shadow_map_of_nodes_against_tracing)->Arg(128)->UseManualTime()->Iterations(9);

}  // namespace mote::benchmarks
