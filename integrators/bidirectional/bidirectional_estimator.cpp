#include "integrators/bidirectional/bidirectional_estimator.h"

#include "integrators/bidirectional/strategy_layers.h"
#include "integrators/eye_path/image_loop.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Rows that are traced before their splats are added: bounds the memory that these take.
constexpr int rows_at_once = 512;
constexpr std::uint32_t light_path_stream = 0x62647074u;

/// With x_{s,t} the path of s vertices from a light and t from the camera, of contribution f and density
/// p_{s,t},
///   L = sum over s, t of w_{s,t}(x_{s,t}) f(x_{s,t}) / p_{s,t}(x_{s,t})    (Veach 1997, Sec. 10.1)
/// for one light path and one eye path a pixel; those with t = 1 are splats on any pixel.
template <bool Media>
class BidirectionalEstimator final : public Estimator {
  public:
    BidirectionalEstimator(const Scene& scene, const RenderOptions& options,
                           const BidirectionalSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          ends_(scene),
          loop_(scene, options, {.by_rows = true}) {
        settings_.limits.wanted = options.cells;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        image.finish_late();  // any light path may reach any pixel
        for (int row = 0; row < options_.height; row += rows_at_once) {
            std::vector<std::vector<Splat>> splats(loop_.tasks());
            const auto trace = [&](EyeTask<Media>& task) {
                trace_pixels(context, image, task, splats[task.index()]);
            };
            if (!loop_.run(context, image, {}, trace, {row, row + rows_at_once})) return false;
            add_splats(splats, context.filter, image);
        }
        return true;
    }
    void add_statistics(Statistics& statistics) const override { loop_.add_statistics(statistics); }

  private:
    void trace_pixels(const PassContext& context, PassImage& image, EyeTask<Media>& task,
                      std::vector<Splat>& splats) {
        const auto light_paths = std::uint32_t(options_.width) * std::uint32_t(options_.height);
        WalkContext& walk = task.walk();
        Strategies<Media> strategies(scene_, ends_, settings_, light_paths, context.filter.radius(), walk);
        task.for_each_pixel([&](int x, int y) {
            const auto path = std::uint32_t(pixel_key(options_, x, y));
            // The light paths of one pass form one set of points.
            Sampler sampler(options_.sampler, options_.seed, path, context.index, light_path_stream);
            walk.rng = Rng(hash_keys(options_.seed, context.index, path, light_path_stream));
            strategies.trace_light_path(sampler, [&](const Contribution& c, const Vec2& film) {
                splats.push_back({film, c.light, std::uint32_t(c.layer)});
                if (sorted(c)) splats.push_back({film, c.light, strategy_layer(c)});
            });
            const EyeRay eye = make_eye_ray(scene_, options_, context, x, y);
            walk.rng = eye.rng;
            strategies.trace_eye_path(eye, [&](const Contribution& c) {
                image.at(c.layer, x, y) += c.light;
                if (sorted(c)) image.at(strategy_layer(c), x, y) += c.light;
            });
        });
    }
    bool sorted(const Contribution& c) const { return c.t > 0 && c.s + c.t - 1 <= settings_.strategies; }
    static std::uint32_t strategy_layer(const Contribution& c) {
        return std::uint32_t(transport_layer_count(Media) + strategy_index(c.s, c.t));
    }

    const Scene& scene_;
    RenderOptions options_;
    BidirectionalSettings settings_;
    LightEnds ends_;
    ImageLoop<Media> loop_;
};

}  // namespace

std::unique_ptr<Estimator> make_bidirectional_estimator(const Scene& scene, const RenderOptions& options,
                                                        const BidirectionalSettings& settings) {
    if (scene.has_media()) return std::make_unique<BidirectionalEstimator<true>>(scene, options, settings);
    return std::make_unique<BidirectionalEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
