#include "integrators/bidirectional/bidirectional_estimator.h"

#include "integrators/bidirectional/strategy_layers.h"
#include "integrators/eye_path/counters.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr int tile_size = 16;
/// Rows that are traced before their splats are added: bounds the memory that these take.
constexpr int rows_at_once = 512;
constexpr std::uint32_t light_path_stream = 0x62647074u;

template <bool Media>
class BidirectionalEstimator final : public Estimator {
  public:
    BidirectionalEstimator(const Scene& scene, const RenderOptions& options,
                           const BidirectionalSettings& settings)
        : scene_(scene), options_(options), settings_(settings), ends_(scene) {
        settings_.limits.wanted = options.cells;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        image.finish_late();  // any light path may reach any pixel
        for (int row = 0; row < options_.height; row += rows_at_once) {
            const int rows = std::min(rows_at_once, options_.height - row);
            const int columns = (options_.width + tile_size - 1) / tile_size;
            std::vector<std::vector<Splat>> splats(std::size_t(columns) *
                                                   std::size_t((rows + tile_size - 1) / tile_size));
            const auto tile = [&](int x0, int y0, int x1, int y1) {
                const auto index = std::size_t(y0 / tile_size * columns + x0 / tile_size);
                render_tile(context, image, splats[index], x0, row + y0, x1, row + y1);
            };
            if (!for_each_tile(options_.width, rows, tile_size, context.cancelled, tile)) return false;
            add_splats(splats, context.filter, image);
        }
        return true;
    }
    void add_statistics(Statistics& statistics) const override { counters_.report(statistics, Media); }

  private:
    void render_tile(const PassContext& context, PassImage& image, std::vector<Splat>& splats, int x0, int y0,
                     int x1, int y1) {
        WalkContext walk;
        walk.cancelled = context.cancelled;
        const auto light_paths = std::uint32_t(options_.width) * std::uint32_t(options_.height);
        Strategies<Media> strategies(scene_, ends_, settings_, light_paths, context.filter.radius(), walk);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
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
            }
        counters_.add(walk.rays, walk.tracking);
    }
    bool sorted(const Contribution& c) const { return c.t > 0 && c.s + c.t - 1 <= settings_.strategies; }
    static std::uint32_t strategy_layer(const Contribution& c) {
        return std::uint32_t(transport_layer_count(Media) + strategy_index(c.s, c.t));
    }

    const Scene& scene_;
    RenderOptions options_;
    BidirectionalSettings settings_;
    LightEnds ends_;
    SharedCounters counters_;
};

}  // namespace

template <bool Media>
std::unique_ptr<Estimator> make_bidirectional_estimator(const Scene& scene, const RenderOptions& options,
                                                        const BidirectionalSettings& settings) {
    return std::make_unique<BidirectionalEstimator<Media>>(scene, options, settings);
}
template std::unique_ptr<Estimator> make_bidirectional_estimator<true>(const Scene&, const RenderOptions&,
                                                                       const BidirectionalSettings&);
template std::unique_ptr<Estimator> make_bidirectional_estimator<false>(const Scene&, const RenderOptions&,
                                                                        const BidirectionalSettings&);

}  // namespace mote::integrators
