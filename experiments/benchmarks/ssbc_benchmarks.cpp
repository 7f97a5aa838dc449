// Screen-space bias compensation against the VPL pass that it corrects: two steps on a picture of 1024 x 768
// pixels, beside 1024 VPLs gathered at every pixel, which is timed on a part of the tiles. Both on one
// thread.
#include <tbb/global_control.h>

#include "core/scene/scattering_vertex.h"
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/turns.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"
#include "screenspace/g_buffer/g_buffer.h"
#include "screenspace/ssbc/ssbc.h"

namespace mote::benchmarks {
namespace {

using namespace core;
using lights::ReceiverTile;

constexpr int width = 1024, height = 768, tile_side = 4;
constexpr int columns = 16, rows = 12;  // tiles that are timed

class Picture {
  public:
    Picture() : scene_(make_room("path", width, height, false)) {
        // As many paths as leave 1024 VPLs, about; all that there are take part.
        vpls_ = lights::trace_light_paths(*scene_, {.paths = 512}, 1, 0, SamplerKind::sobol);
        bound_ = 1024.0f / sqr(scene_->rays().bounds().radius());
        surfaces_ =
            screenspace::ssbc_surfaces(screenspace::make_g_buffer(*scene_, scene_->camera(), width, height));
        light_.assign(surfaces_.reflectance.begin(), surfaces_.reflectance.end());
    }
    double compensate(bool half_resolution) const {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        screenspace::SsbcSettings settings;
        settings.bound = bound_, settings.half_resolution = half_resolution;
        return seconds_of(
            [&] { benchmark::DoNotOptimize(screenspace::compensate(surfaces_, light_, settings)); });
    }
    /// Estimated time of gathering 1024 VPLs over the whole image [s].
    double gather() {
        double seconds = 0.0;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i)
                seconds +=
                    gather_tile((2 * i + 1) * width / (2 * columns), (2 * j + 1) * height / (2 * rows));
        const double all = double(width) * height / (columns * rows * ReceiverTile::width);
        return seconds * all * 1024.0 / double(vpls_.lights.size());
    }

  private:
    double gather_tile(int x0, int y0) {
        ReceiverTile tile;
        tile.clear();
        std::array<ScatteringVertex, ReceiverTile::width> vertices;
        for (int lane = 0; lane < ReceiverTile::width; ++lane) {
            const Vec2 at(float(x0 + lane % tile_side) + 0.5f, float(y0 + lane / tile_side) + 0.5f);
            const Ray ray = scene_->camera().sample_ray(at, Vec2(0.5f));
            const auto hit = scene_->rays().closest(ray);
            if (!hit) continue;
            WalkEvent event;
            event.kind = WalkEvent::Kind::surface, event.distance = hit->t, event.hit = *hit;
            ScatteringVertex& vertex = vertices[std::size_t(lane)] = make_vertex(event, ray);
            tile.set(lane, vertex, Rgb(1.0f), MediumState{}, Rng(std::uint64_t(lane)), 1 << 30);
        }
        return seconds_of([&] {
            const auto light = lights::gather({*scene_, *scratch_, rays_, tracking_}, vpls_,
                                              lights::VplRange{}, lights::BoundedGeometry{bound_}, tile);
            benchmark::DoNotOptimize(light);
        });
    }

    std::unique_ptr<Scene> scene_;
    lights::VplSet vpls_;
    float bound_;
    screenspace::SsbcSurfaces surfaces_;
    std::vector<Rgb> light_;
    std::unique_ptr<lights::GatherScratch> scratch_ = std::make_unique<lights::GatherScratch>();
    RayCounters rays_;
    TrackingCounters tracking_;
};

void ssbc_against_vpl_pass(benchmark::State& state, bool half_resolution) {
    Picture picture;
    take_turns(
        state, 0.1, double(width) * height, [&] { return picture.compensate(half_resolution); },
        [&] { return picture.gather(); });
}
BENCHMARK_CAPTURE(ssbc_against_vpl_pass, full_resolution, false)
    ->UseManualTime()
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ssbc_against_vpl_pass, half_resolution, true)
    ->UseManualTime()
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
