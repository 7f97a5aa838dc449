// Gathering VPLs on surfaces against the bare occlusion tests on the same rays.
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/occlusion_forms.h"
#include "experiments/benchmarks/turns.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::benchmarks {
namespace {

using namespace core;
using lights::ReceiverTile;

constexpr int picture = 256, tile_spacing = 32, tile_side = 4;

/// VPLs in the room and tiles of 4x4 neighbouring pixels, spread evenly over the picture.
class Gathering {
  public:
    explicit Gathering(bool glossy) : scene_(make_room("path", picture, picture, glossy)) {
        vpls_ = lights::trace_light_paths(*scene_, {.paths = 256}, 1, 0, SamplerKind::sobol);
        for (int y = tile_spacing / 2; y < picture; y += tile_spacing)
            for (int x = tile_spacing / 2; x < picture; x += tile_spacing) add_tile(x, y);
    }

    std::size_t tiles() const { return tiles_.size(); }
    std::size_t vpls() const { return vpls_.lights.size(); }
    void gather(std::size_t tile) {
        const auto light = lights::gather({*scene_, *scratch_, rays_, tracking_}, vpls_, lights::VplRange{},
                                          lights::BoundedGeometry{bound_}, tiles_[tile]);
        benchmark::DoNotOptimize(light);
    }
    double gather_all() {
        return seconds_of([&] {
            for (std::size_t i = 0; i < tiles_.size(); ++i) gather(i);
        });
    }
    /// The rays of every tile.
    std::vector<OcclusionRays> log_rays() {
        std::vector<OcclusionRays> all;
        for (std::size_t i = 0; i < tiles_.size(); ++i) {
            RayLog log;
            gather(i);
            log.close();
            all.emplace_back(log);
        }
        return all;
    }

  private:
    void add_tile(int x0, int y0) {
        auto vertices = std::make_unique<std::array<ScatteringVertex, ReceiverTile::width>>();
        ReceiverTile tile;
        tile.clear();
        for (int lane = 0; lane < ReceiverTile::width; ++lane) {
            const Vec2 at(float(x0 + lane % tile_side) + 0.5f, float(y0 + lane / tile_side) + 0.5f);
            const Ray ray = scene_->camera().sample_ray(at, Vec2(0.5f));
            const auto hit = scene_->rays().closest(ray);
            if (!hit) continue;
            WalkEvent event;
            event.kind = WalkEvent::Kind::surface, event.distance = hit->t, event.hit = *hit;
            ScatteringVertex& vertex = (*vertices)[std::size_t(lane)] = make_vertex(event, ray);
            tile.set(lane, vertex, Rgb(1.0f), MediumState{}, Rng(std::uint64_t(lane)), 1 << 30);
        }
        if (!tile.any_active) return;
        tiles_.push_back(tile);
        vertices_.push_back(std::move(vertices));  // tiles point into them
    }

    std::unique_ptr<Scene> scene_;
    lights::VplSet vpls_;
    float bound_ = 100.0f;
    std::vector<ReceiverTile> tiles_;
    std::vector<std::unique_ptr<std::array<ScatteringVertex, ReceiverTile::width>>> vertices_;
    std::unique_ptr<lights::GatherScratch> scratch_ = std::make_unique<lights::GatherScratch>();
    RayCounters rays_;
    TrackingCounters tracking_;
};

double trace_all(const std::vector<OcclusionRays>& tiles, const OcclusionRays::Form& form) {
    double seconds = 0.0;
    for (const OcclusionRays& tile : tiles) seconds += form.seconds(tile);
    return seconds;
}

double count_rays(const std::vector<OcclusionRays>& tiles) {
    double rays = 0.0;
    for (const OcclusionRays& tile : tiles) rays += double(tile.size());
    return rays;
}

void gather_against_bare_occlusion(benchmark::State& state, bool glossy, double target) {
    Gathering gathering(glossy);
    const auto rays = gathering.log_rays();
    const auto form = OcclusionRays::forms()[fastest_form(rays)];
    state.SetLabel("bare: " + form.name);
    take_turns(
        state, target, count_rays(rays), [&] { return gathering.gather_all(); },
        [&] { return trace_all(rays, form); });
    state.counters["vpls"] = double(gathering.vpls());
    state.counters["rays"] = count_rays(rays);
    state.counters["connections"] =
        double(gathering.vpls()) * double(gathering.tiles()) * ReceiverTile::width;
}
BENCHMARK_CAPTURE(gather_against_bare_occlusion, diffuse, false, 1.2)
    ->UseManualTime()
    ->Iterations(25)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(gather_against_bare_occlusion, one_glossy_ball, true, no_target)
    ->UseManualTime()
    ->Iterations(15)
    ->Unit(benchmark::kMillisecond);

/// Absolute rates of every form on the gathering's rays.
void forms_of_occlusion(benchmark::State& state) {
    static Gathering gathering(false);  // owns the scene that the rays refer to
    static const auto rays = gathering.log_rays();
    const auto form = OcclusionRays::forms()[std::size_t(state.range(0))];
    state.SetLabel(form.name);
    std::vector<double> seconds;
    for (auto _ : state) {
        seconds.push_back(trace_all(rays, form));
        state.SetIterationTime(seconds.back());
    }
    state.counters["bare_M_per_s"] = 1e-6 * count_rays(rays) / median(seconds);
}
BENCHMARK(forms_of_occlusion)
    ->DenseRange(0, int(OcclusionRays::forms().size()) - 1)
    ->UseManualTime()
    ->Iterations(10)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
