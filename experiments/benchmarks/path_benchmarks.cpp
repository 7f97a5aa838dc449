// The path tracer against the bare rays that it traces, and volpath against path where there are no media.
#include <tbb/global_control.h>

#include "core/render/render_driver.h"
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/ray_log.h"
#include "experiments/benchmarks/turns.h"

namespace mote::benchmarks {
namespace {

using namespace core;

constexpr int width = 192, height = 192;

/// One integrator ready to render passes on one thread.
class Renderer {
  public:
    explicit Renderer(const std::string& type)
        : scene_(make_room(type, width, height)),
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

/// The rays of a path, one by one and in its order: nothing else is known to a path tracer in time.
double trace_bare(const std::vector<LoggedRay>& rays) {
    float sum = 0.0f;
    const double seconds = seconds_of([&] {
        for (const LoggedRay& logged : rays) {
            if (logged.occlusion) {
                RTCRay ray = logged.ray;
                bare_occluded(logged.scene, ray);
                sum += ray.tfar;
            } else {
                RTCRayHit query;
                query.ray = logged.ray;
                query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
                bare_intersect(logged.scene, query);
                sum += query.ray.tfar;
            }
        }
    });
    benchmark::DoNotOptimize(sum);
    return seconds;
}

void path_against_bare_rays(benchmark::State& state) {
    Renderer path("path");
    RayLog log;
    path.pass();
    log.close();
    take_turns(
        state, 1.6, double(log.rays.size()), [&] { return path.pass(); },
        [&] { return trace_bare(log.rays); });
    state.counters["rays"] = double(log.rays.size());
}
BENCHMARK(path_against_bare_rays)->UseManualTime()->Iterations(15)->Unit(benchmark::kMillisecond);

void volpath_against_path(benchmark::State& state) {
    Renderer volpath("volpath"), path("path");
    take_turns(
        state, 1.03, double(width * height), [&] { return volpath.pass(); }, [&] { return path.pass(); });
}
BENCHMARK(volpath_against_path)->UseManualTime()->Iterations(25)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
