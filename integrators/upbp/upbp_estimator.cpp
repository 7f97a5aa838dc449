#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "core/render/camera_ray.h"
#include "gathering/photon_maps/progressive_radius.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/upbp/merges.h"
#include "integrators/upbp/upbp_settings.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint32_t light_path_stream = 0x75706270u;
/// With more light paths than this in a pass kernels are smaller, so that a query costs no more.
constexpr double paths_of_first_radius = 1e4;

/// Sum over all connections of a pixel's light path with its eye path, and over all merges of its eye path
/// with the light paths of every pixel, each by its MIS weight (Křivánek et al. 2014).
template <bool Media>
class UpbpEstimator final : public Estimator {
  public:
    UpbpEstimator(const Scene& scene, const RenderOptions& options, const UpbpSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          ends_(scene),
          loop_(scene, options, {.by_rows = true}) {
        settings_.limits.wanted = options.cells;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        image.finish_late();  // any light path may reach any pixel
        const BidirectionalSettings settings = settings_of(context.index);
        std::vector<std::vector<Splat>> splats(std::size_t(options_.height));
        std::vector<Subpath> paths(std::size_t(options_.width));  // of the first row, until all have room
        if (!trace_light_paths(context, settings, paths, splats)) return false;
        add_splats(splats, context.filter, image);
        const LightVertices lights(paths, settings.merging);
        on_surfaces_ += lights.on_surfaces(), in_media_ += lights.in_media();
        return loop_.run(context, image, {}, [&](EyeTask<Media>& task) {
            trace_eye_paths(context, settings, paths, lights, image, task);
        });
    }
    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        statistics.values["light_vertices_on_surfaces"] += double(on_surfaces_);
        statistics.values["light_vertices_in_media"] += double(in_media_);
        statistics.values["kernel_radius_surface"] = radius_;
    }

  private:
    std::size_t pixels() const { return std::size_t(options_.width) * std::size_t(options_.height); }

    BidirectionalSettings settings_of(std::uint32_t pass) {
        BidirectionalSettings s;
        s.limits = settings_.limits, s.heuristic = settings_.heuristic;
        s.all_connections = settings_.all_connections, s.connections = settings_.connections;
        const double size = double(scene_.bounds().radius());
        const double first = settings_.radius * (size > 0.0 ? size : 1.0);
        const auto set = [&](Merge technique, bool used, int dimensions) {
            const double fraction =
                gathering::radius_fraction(pass, settings_.alpha, dimensions) *
                gathering::radius_for_paths(double(pixels()), paths_of_first_radius, dimensions);
            s.merging.radius[std::size_t(technique)] = used ? first * fraction : 0.0;
        };
        set(Merge::surface, settings_.surface, 2);
        set(Merge::point_point_3d, Media && settings_.point_point, 3);
        set(Merge::point_beam_2d, Media && settings_.point_beam, 2);
        s.merging.light_subpaths = double(pixels());
        radius_ = s.merging.radius[std::size_t(Merge::surface)];
        return s;
    }

    bool trace_light_paths(const PassContext& context, const BidirectionalSettings& settings,
                           std::vector<Subpath>& paths, std::vector<std::vector<Splat>>& splats) {
        const auto rows = [&](int begin, int end) {
            tbb::parallel_for(begin, end, [&](int y) {
                if (!context.cancelled) trace_row(context, settings, y, paths, splats[std::size_t(y)]);
            });
        };
        rows(0, 1);
        require_memory(paths);
        paths.resize(pixels());
        rows(1, options_.height);
        return !context.cancelled;
    }
    /// By the vertices of the first row.
    void require_memory(const std::vector<Subpath>& paths) const {
        double vertices = 0.0;
        for (int x = 0; x < options_.width; ++x) vertices += double(paths[std::size_t(x)].size());
        const double each =
            double(sizeof(Subpath)) + vertices / options_.width * LightVertices::bytes_per_vertex;
        options_.memory.require(
            each * double(pixels()), fmt::format("the vertices of {} light subpaths", pixels()),
            [each](double bytes) { return fmt::format("{:.0f} subpaths fit", std::floor(bytes / each)); });
    }
    void trace_row(const PassContext& context, const BidirectionalSettings& settings, int y,
                   std::vector<Subpath>& paths, std::vector<Splat>& splats) {
        WalkContext walk;
        walk.cancelled = context.cancelled;
        Strategies<Media> strategies(scene_, ends_, settings, std::uint32_t(pixels()),
                                     context.filter.radius(), walk);
        for (int x = 0; x < options_.width; ++x) {
            const auto path = std::uint32_t(pixel_key(options_, x, y));
            Sampler sampler(options_.sampler, options_.seed, path, context.index, light_path_stream);
            walk.rng = Rng(hash_keys(options_.seed, context.index, path, light_path_stream));
            strategies.trace_light_path(sampler, [&](const Contribution& c, const Vec2& film) {
                splats.push_back({film, c.light, std::uint32_t(c.layer)});
            });
            paths[index_of(x, y)] = strategies.light_path();
        }
        loop_.counters().add(walk.rays, walk.tracking);
    }
    void trace_eye_paths(const PassContext& context, const BidirectionalSettings& settings,
                         const std::vector<Subpath>& paths, const LightVertices& lights, PassImage& image,
                         EyeTask<Media>& task) {
        WalkContext& walk = task.walk();
        Strategies<Media> strategies(scene_, ends_, settings, std::uint32_t(pixels()),
                                     context.filter.radius(), walk);
        Merges<Media> merges(strategies, lights, settings, walk);
        task.for_each_pixel([&](int x, int y) {
            if (context.cancelled) return;
            strategies.take_light_path(paths[index_of(x, y)]);
            const EyeRay eye = make_eye_ray(scene_, options_, context, x, y);
            walk.rng = eye.rng;
            const auto found = [&](const Contribution& c) { image.at(c.layer, x, y) += c.light; };
            strategies.trace_eye_path(eye, found, [&](const SubpathWalk<Media>& edge, bool continues) {
                merges.after_step(edge, continues, found);
            });
        });
    }
    std::size_t index_of(int x, int y) const {
        return std::size_t(y) * std::size_t(options_.width) + std::size_t(x);
    }

    const Scene& scene_;
    RenderOptions options_;
    UpbpSettings settings_;
    LightEnds ends_;
    ImageLoop<Media> loop_;
    std::uint64_t on_surfaces_ = 0, in_media_ = 0;
    double radius_ = 0.0;
};

}  // namespace

std::unique_ptr<Estimator> make_upbp_estimator(const Scene& scene, const RenderOptions& options,
                                               const UpbpSettings& settings) {
    if (scene.has_media()) return std::make_unique<UpbpEstimator<true>>(scene, options, settings);
    return std::make_unique<UpbpEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
