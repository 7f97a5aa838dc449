#include "integrators/vpl_ray_bundles/vpl_bundle_estimator.h"

#include <mutex>

#include "integrators/eye_path/counters.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/layer_filter/layer_filter.h"
#include "integrators/vpl_ray_bundles/vpl_bundle_tile.h"

namespace mote::integrators {

using namespace core;
namespace {

class VplBundleEstimator final : public Estimator {
  public:
    VplBundleEstimator(const Scene& scene, const RenderOptions& options, const VplBundleSettings& settings)
        : scene_(scene), options_(options), settings_(settings) {
        settings_.eye.wanted = options.cells;
        settings_.sky = settings_.sky && settings_.has_bundles() && scene.environment();
        const bool wants_direct =
            settings_.eye.wanted[Transport::direct] || settings_.eye.wanted[Transport::emission];
        eye_paths_ = wants_direct ? settings_.direct_paths() : 1;
        if (settings_.imperfect_links && settings_.has_bundles())
            links_ = std::make_unique<gathering::ImperfectLinks>(
                scene.shapes(),
                gathering::ImperfectLinkSettings{.memory_budget = options.memory.at_most(
                                                     gathering::ImperfectLinkSettings().memory_budget)});
        if (settings_.filters) filter_.emplace(scene, options, LayerFilterParameters());
    }

    void finish(Film& film, CancelToken cancelled) override {
        if (filter_ && film.has_passes(2))
            filter_->apply(film,
                           std::array{LayerFilter::Choice{std::size_t(Transport::indirect),
                                                          screenspace::LayerKind::surface}},
                           cancelled);
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        const double begin = process_cpu_seconds();
        const VplBundlePass pass(scene_, settings_, links_.get(), options_, context);
        light_seconds_ += process_cpu_seconds() - begin;
        counters_.add(pass.vpls.rays, pass.vpls.tracking);
        vpls_ += pass.vpls.lights.size(), paths_ += pass.vpls.paths;
        bytes_ = std::max(bytes_,
                          pass.vpls.memory_bytes() + pass.rivals.size() * sizeof(float) + pass.kept_bytes());
        return for_each_tile(
            options_.width, options_.height, tile_size(), context.cancelled,
            [&](int x0, int y0, int x1, int y1) { render_tile(context, pass, image, x0, y0, x1, y1); });
    }

    void add_statistics(Statistics& statistics) const override {
        counters_.report(statistics, false);
        statistics.values["vpls"] += double(vpls_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["vpl_bytes_peak"] = double(bytes_);
        // Table 1 of the paper.
        statistics.values["light_path_cpu_seconds"] += light_seconds_;
        statistics.values["eye_path_cpu_seconds"] += time_.eye;
        statistics.values["vpl_cpu_seconds"] += time_.vpls;
        statistics.values["bundle_cpu_seconds"] += time_.bundles;
        if (filter_) {
            statistics.seconds["filter_features"] = filter_->feature_seconds();
            statistics.seconds["filter"] = filter_->filter_seconds();
        }
    }

  private:
    /// Pixels of a task: a multiple of the tiles of receivers, whose pixels are `interleaving` apart.
    int tile_size() const {
        const int n = settings_.interleaving;
        return VplBundleTile::side * n * std::max(1, 4 / n);
    }

    void render_tile(const PassContext& context, const VplBundlePass& pass, PassImage& image, int x0, int y0,
                     int x1, int y1) {
        WalkContext walk;
        walk.cancelled = context.cancelled;
        const auto scratch = std::make_unique<lights::GatherScratch>();
        const auto tile = std::make_unique<VplBundleTile>(scene_, settings_, pass, *scratch, walk);
        const int n = settings_.interleaving, side = VplBundleTile::side * n;
        for (int place = 0; place < n * n; ++place) {
            const auto& lines = pass.lines[std::size_t(place)];
            for (int y = y0; y < y1; y += side)
                for (int x = x0; x < x1; x += side) {
                    if (context.cancelled) return;
                    render_lanes(context, image, *tile, lines, x + place % n, y + place / n, x1, y1);
                }
        }
        counters_.add(walk.rays, walk.tracking);
        const std::lock_guard lock(time_mutex_);
        time_.eye += tile->time().eye, time_.vpls += tile->time().vpls, time_.bundles += tile->time().bundles;
    }

    /// Pixels from (x0, y0) on, n apart. They go round the n^2 shares of the VPLs from pass to pass.
    void render_lanes(const PassContext& context, PassImage& image, VplBundleTile& tile,
                      std::span<const gathering::BundleDirection> lines, int x0, int y0, int x1,
                      int y1) const {
        constexpr int side = VplBundleTile::side;
        const int n = settings_.interleaving;
        const std::size_t shares = std::size_t(n) * std::size_t(n);
        const std::size_t start = std::size_t(hash_keys(options_.seed, 0x696e7465726cull) % shares);
        const std::size_t place = std::size_t(x0 % n) + std::size_t(n) * std::size_t(y0 % n);
        const auto pixel = [&](int lane) { return std::array{x0 + lane % side * n, y0 + lane / side * n}; };
        for (int lane = 0; lane < VplBundleTile::width; ++lane)
            if (const auto [x, y] = pixel(lane); x < x1 && y < y1)
                tile.start(lane, eye_ray(context, x, y, 0), eye_paths_);
            else
                tile.stop(lane);
        tile.run({(place + start + context.index) % shares, shares}, lines);
        for (int lane = 0; lane < VplBundleTile::width; ++lane)
            if (const auto [x, y] = pixel(lane); x < x1 && y < y1) {
                for (int k = 1; k < eye_paths_; ++k) tile.add_direct(lane, eye_ray(context, x, y, k));
                store(tile.sum(lane), image, x, y, false);
            }
    }

    /// Eye path k of a pixel's in this pass; they are numbered on from pass to pass.
    EyeRay eye_ray(const PassContext& context, int x, int y, int k) const {
        const PassContext path{context.index * std::uint32_t(eye_paths_) + std::uint32_t(k), context.filter,
                               context.cancelled, context.part};
        return make_eye_ray(scene_, options_, path, x, y);
    }

    const Scene& scene_;
    RenderOptions options_;
    VplBundleSettings settings_;
    int eye_paths_ = 1;                                       ///< of a pixel and pass
    std::unique_ptr<const gathering::ImperfectLinks> links_;  ///< null: rays are traced
    std::optional<LayerFilter> filter_;                       ///< nothing: pixels stay as they are
    SharedCounters counters_;
    std::mutex time_mutex_;
    VplBundleTime time_;
    double light_seconds_ = 0.0;
    std::uint64_t vpls_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<Estimator> make_vpl_bundle_estimator(const Scene& scene, const RenderOptions& options,
                                                     const VplBundleSettings& settings) {
    return std::make_unique<VplBundleEstimator>(scene, options, settings);
}

}  // namespace mote::integrators
