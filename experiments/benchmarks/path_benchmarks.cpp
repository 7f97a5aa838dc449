// The path tracer against the bare rays that it traces, and volpath against path where there are no media.
#include <tbb/global_control.h>

#include "core/formats/xml/scene_loader.h"
#include "core/render/render_driver.h"
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/ray_log.h"
#include "experiments/benchmarks/turns.h"
#include "session/registry.h"

namespace mote::benchmarks {
namespace {

using namespace core;

constexpr int width = 192, height = 192;

/// One integrator ready to render passes on one thread.
class Renderer {
  public:
    explicit Renderer(std::unique_ptr<Scene> scene)
        : scene_(std::move(scene)),
          estimator_(scene_->integrator()->prepare(*scene_, {1, width, height, SamplerKind::sobol})),
          filter_(make_pixel_filter("box", 0.5f, 0.5f)),
          image_(width, height, scene_->integrator()->layers(*scene_).size()) {}

    double pass() {
        const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
        image_.clear();
        return seconds_of([&] { estimator_->pass({0, *filter_, cancelled_}, image_); });
    }

  private:
    std::unique_ptr<Scene> scene_;
    std::unique_ptr<Estimator> estimator_;
    std::unique_ptr<PixelFilter> filter_;
    PassImage image_;
    const std::atomic<bool> cancelled_{false};
};

std::unique_ptr<Scene> half_million() { return make_room("path", width, height); }

/// 32 triangles: rays are cheap, and what a path tracer does besides is dear.
std::unique_ptr<Scene> cornell_box() {
    LoadOptions options;
    options.integrator = "path";
    options.defines = {{"resx", std::to_string(width)}, {"resy", std::to_string(height)}};
    return load_scene(MOTE_SOURCE_DIR "/scenes/cornell_box.xml", session::make_registry(), options);
}

void path_against_bare_rays(benchmark::State& state, std::unique_ptr<Scene> (*scene)(), double target) {
    Renderer path(scene());
    RayLog log;
    path.pass();
    log.close();
    take_turns(
        state, target, double(log.rays.size()), [&] { return path.pass(); },
        [&] { return trace_bare(log.rays); });
    state.counters["rays"] = double(log.rays.size());
}
BENCHMARK_CAPTURE(path_against_bare_rays, half_million, half_million, 1.5)
    ->UseManualTime()
    ->Iterations(15)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path_against_bare_rays, cornell_box, cornell_box, 2.5)
    ->UseManualTime()
    ->Iterations(15)
    ->Unit(benchmark::kMillisecond);

void volpath_against_path(benchmark::State& state) {
    Renderer volpath(make_room("volpath", width, height)), path(half_million());
    take_turns(
        state, 1.03, double(width * height), [&] { return volpath.pass(); }, [&] { return path.pass(); });
}
BENCHMARK(volpath_against_path)->UseManualTime()->Iterations(25)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
