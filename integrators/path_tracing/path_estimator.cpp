#include "integrators/path_tracing/path_estimator.h"

#include "integrators/eye_path/counters.h"
#include "integrators/eye_path/eye_ray.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr int tile_size = 16;

template <bool Media>
class PathEstimator final : public Estimator {
  public:
    PathEstimator(const Scene& scene, const RenderOptions& options, const PathSettings& settings)
        : scene_(scene), options_(options), settings_(settings) {
        settings_.limits.wanted = options.cells;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        return for_each_tile(options_.width, options_.height, tile_size, context.cancelled,
                             [&](int x0, int y0, int x1, int y1) {
                                 WalkContext walk;
                                 walk.cancelled = context.cancelled;
                                 for (int y = y0; y < y1; ++y)
                                     for (int x = x0; x < x1; ++x) render_pixel(context, image, x, y, walk);
                                 counters_.add(walk.rays, walk.tracking);
                             });
    }
    void add_statistics(Statistics& statistics) const override { counters_.report(statistics, Media); }

  private:
    void render_pixel(const PassContext& context, PassImage& image, int x, int y, WalkContext& walk) const {
        const EyeRay eye = make_eye_ray(scene_, options_, context, x, y);
        walk.rng = eye.rng;
        store(trace_path<Media>(scene_, settings_, eye, walk), image, x, y, Media);
    }

    const Scene& scene_;
    RenderOptions options_;
    PathSettings settings_;
    SharedCounters counters_;
};

}  // namespace

template <bool Media>
std::unique_ptr<Estimator> make_path_estimator(const Scene& scene, const RenderOptions& options,
                                               const PathSettings& settings) {
    return std::make_unique<PathEstimator<Media>>(scene, options, settings);
}
template std::unique_ptr<Estimator> make_path_estimator<true>(const Scene&, const RenderOptions&,
                                                              const PathSettings&);
template std::unique_ptr<Estimator> make_path_estimator<false>(const Scene&, const RenderOptions&,
                                                               const PathSettings&);

}  // namespace mote::integrators
