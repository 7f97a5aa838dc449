#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "core/render/camera_ray.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/upbp/merge_schedule.h"
#include "integrators/upbp/merges.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint32_t light_path_stream = 0x75706270u;

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
        Lights lights;
        lights.paths.resize(std::size_t(options_.width));  // of the first row, until all have room
        lights.beams_of_row.resize(std::size_t(options_.height));
        if (!trace_light_paths(context, settings, lights, splats)) return false;
        add_splats(splats, context.filter, image);
        lights.vertices = LightVertices(lights.paths, settings.merging);
        if (settings.merging.uses(Merge::beam_beam_1d))
            lights.beams = LightBeams(lights.paths, lights.beams_of_row, settings.merging.light_beams,
                                      settings.merging.radius[std::size_t(Merge::beam_beam_1d)],
                                      double(scene_.bounds().radius()));
        on_surfaces_ += lights.vertices.on_surfaces(), in_media_ += lights.vertices.in_media();
        beams_ += lights.beams.size();
        return loop_.run(context, image, {}, [&](EyeTask<Media>& task) {
            trace_eye_paths(context, settings, lights, image, task);
        });
    }
    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        statistics.values["light_vertices_on_surfaces"] += double(on_surfaces_);
        statistics.values["light_vertices_in_media"] += double(in_media_);
        statistics.values["light_beams"] += double(beams_);
        statistics.values["kernel_radius_surface"] = radius_;
    }

  private:
    /// Evenly spread.
    bool has_beams(std::size_t path) const {
        const std::size_t count = paths_with_beams(pixels());
        return (path + 1) * count / pixels() > path * count / pixels();
    }
    /// The light subpaths of a pass.
    struct Lights {
        std::vector<Subpath> paths;
        std::vector<std::vector<LightBeam>> beams_of_row;
        LightVertices vertices;
        LightBeams beams;
    };
    std::size_t pixels() const { return std::size_t(options_.width) * std::size_t(options_.height); }

    BidirectionalSettings settings_of(std::uint32_t pass) {
        BidirectionalSettings s;
        s.limits = settings_.limits, s.heuristic = settings_.heuristic;
        s.all_connections = settings_.all_connections, s.connections = settings_.connections;
        s.merging = merges_of_pass(settings_, pass, double(scene_.bounds().radius()), pixels(), Media);
        s.merging.light_beams = possible_length(scene_, settings_.light_beams);
        s.merging.eye_beams = possible_length(scene_, settings_.query_beams);
        radius_ = s.merging.radius[std::size_t(Merge::surface)];
        return s;
    }

    bool trace_light_paths(const PassContext& context, const BidirectionalSettings& settings, Lights& lights,
                           std::vector<std::vector<Splat>>& splats) {
        const auto rows = [&](int begin, int end) {
            tbb::parallel_for(begin, end, [&](int y) {
                if (!context.cancelled) trace_row(context, settings, y, lights, splats[std::size_t(y)]);
            });
        };
        rows(0, 1);
        require_memory(lights);
        lights.paths.resize(pixels());
        rows(1, options_.height);
        return !context.cancelled;
    }
    /// By the vertices and beams of the first row.
    void require_memory(const Lights& lights) const {
        double first_row = 0.0;
        for (int x = 0; x < options_.width; ++x)
            first_row += double(lights.paths[std::size_t(x)].size()) * LightVertices::bytes_per_vertex;
        for (const LightBeam& b : lights.beams_of_row[0]) first_row += LightBeams::bytes_of(b);
        const double each = double(sizeof(Subpath)) + first_row / options_.width;
        options_.memory.require(
            each * double(pixels()), fmt::format("the vertices of {} light subpaths", pixels()),
            [each](double bytes) { return fmt::format("{:.0f} subpaths fit", std::floor(bytes / each)); });
    }
    void trace_row(const PassContext& context, const BidirectionalSettings& settings, int y, Lights& lights,
                   std::vector<Splat>& splats) {
        WalkContext walk;
        walk.cancelled = context.cancelled;
        Strategies<Media> strategies(scene_, ends_, settings, std::uint32_t(pixels()),
                                     context.filter.radius(), walk);
        for (int x = 0; x < options_.width; ++x) {
            const auto path = std::uint32_t(pixel_key(options_, x, y));
            Sampler sampler(options_.sampler, options_.seed, path, context.index, light_path_stream);
            walk.rng = Rng(hash_keys(options_.seed, context.index, path, light_path_stream));
            const auto splat = [&](const Contribution& c, const Vec2& film) {
                splats.push_back({film, c.light, std::uint32_t(c.layer)});
            };
            const auto after_step = [&](SubpathWalk<Media>& edge) {
                if (!has_beams(index_of(x, y))) return;
                for (Beam& beam : edge.beams())
                    lights.beams_of_row[std::size_t(y)].push_back(
                        {std::uint32_t(index_of(x, y)), strategies.light_start(), std::move(beam)});
            };
            strategies.trace_light_path(sampler, splat, after_step);
            lights.paths[index_of(x, y)] = strategies.light_path();
        }
        loop_.counters().add(walk.rays, walk.tracking);
    }
    void trace_eye_paths(const PassContext& context, const BidirectionalSettings& settings,
                         const Lights& lights, PassImage& image, EyeTask<Media>& task) {
        WalkContext& walk = task.walk();
        Strategies<Media> strategies(scene_, ends_, settings, std::uint32_t(pixels()),
                                     context.filter.radius(), walk);
        Merges<Media> merges(scene_, ends_, strategies, lights.vertices, lights.beams, settings, walk);
        task.for_each_pixel([&](int x, int y) {
            if (context.cancelled) return;
            strategies.take_light_path(lights.paths[index_of(x, y)]);
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
    std::uint64_t on_surfaces_ = 0, in_media_ = 0, beams_ = 0;
    double radius_ = 0.0;
};

}  // namespace

BeamLength possible_length(const Scene& scene, BeamLength wanted) {
    return short_beams_possible(scene) ? wanted : BeamLength::long_beam;
}

std::unique_ptr<Estimator> make_upbp_estimator(const Scene& scene, const RenderOptions& options,
                                               const UpbpSettings& settings) {
    if (scene.has_media()) return std::make_unique<UpbpEstimator<true>>(scene, options, settings);
    return std::make_unique<UpbpEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
