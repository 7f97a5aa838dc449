#include "integrators/path_tracing/path_estimator.h"

#include "integrators/eye_path/eye_ray.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr int tile_size = 16;

template <bool Media>
class PathEstimator final : public Estimator {
  public:
    PathEstimator(const Scene& scene, const RenderOptions& options, const PathSettings& settings)
        : scene_(scene), options_(options), settings_(settings) {}

    bool pass(const PassContext& context, PassImage& image) override {
        return for_each_tile(options_.width, options_.height, tile_size, context.cancelled,
                             [&](int x0, int y0, int x1, int y1) {
                                 WalkContext walk;
                                 for (int y = y0; y < y1; ++y)
                                     for (int x = x0; x < x1; ++x) render_pixel(context, image, x, y, walk);
                                 counters_.add(walk.rays, walk.tracking);
                             });
    }
    void add_statistics(Statistics& statistics) const override { counters_.report(statistics, Media); }

  private:
    void render_pixel(const PassContext& context, PassImage& image, int x, int y, WalkContext& walk) const {
        EyeRay eye = make_eye_ray(scene_, options_, context, x, y);
        walk.rng = eye.rng;
        MediumState state;
        if constexpr (Media) state = scene_.camera_medium_state();
        store(trace_path<Media>(scene_, settings_, eye.ray, state, eye.sampler, walk), image, x, y, Media);
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

PathSettings read_path_settings(const Properties& properties) {
    PathSettings settings;
    settings.max_depth = int(properties.get_int("max_depth", -1));
    if (settings.max_depth < -1 || settings.max_depth == 0)
        throw InputError("max_depth must be -1 (no limit) or at least 1", properties.where_of("max_depth"));
    settings.rr_depth = int(properties.get_int("rr_depth", 5));
    if (settings.rr_depth < 1)
        throw InputError("rr_depth must be at least 1", properties.where_of("rr_depth"));
    return settings;
}

std::vector<Parameter> path_parameters() {
    return {{"max_depth", "integer", "-1",
             "longest path in edges: 1 emission only, 2 direct light, -1 no limit; a scattering in a medium "
             "counts, "
             "a null collision does not"},
            {"rr_depth", "integer", "5", "depth from which Russian roulette may end a path"}};
}

}  // namespace mote::integrators
