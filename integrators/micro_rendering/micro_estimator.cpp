#include "integrators/micro_rendering/micro_estimator.h"

#include <tbb/parallel_for.h>

#include "core/render/cpu_clock.h"
#include "integrators/eye_path/counters.h"
#include "integrators/micro_rendering/micro_eye_tile.h"

namespace mote::integrators {

using namespace core;
namespace {

class MicroEstimator final : public Estimator {
  public:
    MicroEstimator(const Scene& scene, const RenderOptions& options, const MicroSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          surfaces_(gathering::surface_triangles(
              scene.shapes(), {.memory_budget = options.memory.at_most(std::size_t(4) << 30)})) {
        settings_.eye.wanted = options.cells;
        settings_.points.bound = bound();
        settings_.points.memory_budget = options.memory.at_most(settings_.points.memory_budget);
        settings_.points.paths.memory = options.memory;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        const double begin = process_cpu_seconds();
        const gathering::LitPoints points(scene_, surfaces_, scene_.shapes(), point_settings(),
                                          settings_.buffers, options_.seed, context.index, options_.sampler,
                                          context.cancelled);
        const double lit = process_cpu_seconds();
        add_cost(points.cost(), lit - begin);
        std::optional<SharedPixels> shared;
        if (settings_.upsampling > 1) {
            shared.emplace(options_.width, options_.height, lattice(context));
            image.finish_late();
        }
        const auto tile = [&](int x0, int y0, int x1, int y1) {
            render_tile(context, points, image, shared ? &*shared : nullptr, {x0, y0, x1, y1});
        };
        const bool complete =
            for_each_tile(options_.width, options_.height, tile_size(), context.cancelled, tile) &&
            (!shared || upsample(context, points, *shared, image));
        gather_seconds_ += process_cpu_seconds() - lit;
        return complete;
    }

    void add_statistics(Statistics& statistics) const override {
        counters_.report(statistics, false);
        statistics.values["points"] = double(settings_.points.points);
        statistics.values["places"] += double(places_);
        statistics.values["receivers"] += double(receivers_.load());
        statistics.values["point_bytes_peak"] = double(bytes_);
        // Engelhardt 2013, Fig. 8.12 plots the second.
        statistics.values["light_cpu_seconds"] += light_seconds_;
        statistics.values["gather_cpu_seconds"] += gather_seconds_;
        if (settings_.points.light == gathering::StoredLight::vpls)
            statistics.values["vpls"] += double(light_points_);
        if (settings_.points.light == gathering::StoredLight::photons)
            statistics.values["photons_on_surfaces"] += double(light_points_);
        if (settings_.upsampling > 1) statistics.values["pixels_shaded_again"] += double(shaded_again_);
    }

  private:
    static constexpr std::size_t lane_count = std::size_t(MicroEyeTile::width);
    using Lanes = std::array<glm::ivec2, lane_count>;  ///< pixels; x < 0: none
    struct Box {
        int x0, y0, x1, y1;
    };

    /// The automatic bound is that of mote_vpl.
    float bound() const {
        if (settings_.bound) return *settings_.bound > 0.0f ? *settings_.bound : infinity;
        const float radius = scene_.rays().bounds().radius();
        return radius > 0.0f ? float(settings_.points.paths.paths) / sqr(radius) : infinity;
    }
    /// A single point without light where indirect light is not wanted.
    gathering::LitPointSettings point_settings() const {
        gathering::LitPointSettings points = settings_.points;
        if (settings_.eye.wanted[Transport::indirect] && settings_.max_bounces() != 0) return points;
        points.points = 1, points.light = gathering::StoredLight::direct;
        return points;
    }
    void add_cost(const gathering::LitPointCost& cost, double seconds) {
        counters_.add(cost.rays, cost.tracking);
        places_ += cost.places, light_points_ += cost.light_points, bytes_ = std::max(bytes_, cost.bytes);
        light_seconds_ += seconds;
    }

    /// Pixels of a task: a multiple of the tiles of receivers, whose pixels are `upsampling` apart.
    int tile_size() const {
        const int n = settings_.upsampling;
        return MicroEyeTile::side * n * std::max(1, 4 / n);
    }
    /// The lattice goes round from pass to pass.
    screenspace::ShadedLattice lattice(const PassContext& context) const {
        const auto n = std::uint32_t(settings_.upsampling);
        const std::uint32_t at = context.index % (n * n);
        return {int(n), int(at % n), int(at / n)};
    }

    template <typename Render>
    void with_tile(const PassContext& context, const gathering::LitPoints& points, const Render& render) {
        WalkContext walk;
        walk.cancelled = context.cancelled;
        const auto tile = std::make_unique<MicroEyeTile>(scene_, settings_, points, walk);
        render(*tile);
        counters_.add(walk.rays, walk.tracking);
        receivers_ += tile->receivers();
    }

    void render_tile(const PassContext& context, const gathering::LitPoints& points, PassImage& image,
                     SharedPixels* shared, const Box& box) {
        constexpr int side = MicroEyeTile::side;
        const int n = settings_.upsampling;
        with_tile(context, points, [&](MicroEyeTile& tile) {
            for (int y = box.y0; y < box.y1; y += side * n)
                for (int x = box.x0; x < box.x1; x += side * n)
                    for (int i = 0; i < n * n; ++i) {
                        if (context.cancelled) return;
                        Lanes lanes;
                        for (int lane = 0; lane < side * side; ++lane) {
                            const glm::ivec2 pixel(x + i % n + lane % side * n, y + i / n + lane / side * n);
                            lanes[std::size_t(lane)] =
                                pixel.x < box.x1 && pixel.y < box.y1 ? pixel : glm::ivec2(-1);
                        }
                        tile.gathers(!shared || shared->lattice().holds(x + i % n, y + i / n));
                        render_lanes(context, image, tile, lanes, shared);
                    }
        });
    }

    /// Pixels between the lattice: those without similar neighbours once more, with buffers of their own
    /// (Engelhardt 2013, Sec. 8.2.3), the others by neighbours.
    bool upsample(const PassContext& context, const gathering::LitPoints& points, const SharedPixels& shared,
                  PassImage& image) {
        const std::vector<std::uint32_t> again = shared.again();
        constexpr std::size_t task = 256;
        tbb::parallel_for(std::size_t(0), (again.size() + task - 1) / task, [&](std::size_t t) {
            with_tile(context, points, [&](MicroEyeTile& tile) {
                const std::size_t end = std::min((t + 1) * task, again.size());
                for (std::size_t i = t * task; i < end && !context.cancelled; i += lane_count) {
                    Lanes lanes;
                    for (std::size_t lane = 0; lane < lane_count; ++lane) {
                        const auto pixel = i + lane < end ? int(again[i + lane]) : -1;
                        lanes[lane] = pixel < 0 ? glm::ivec2(-1)
                                                : glm::ivec2(pixel % options_.width, pixel / options_.width);
                    }
                    render_lanes(context, image, tile, lanes, nullptr);
                }
            });
        });
        shaded_again_ += again.size();
        if (context.cancelled) return false;
        const auto indirect = std::size_t(Transport::indirect);
        shared.fill(screenspace::LayerKind::surface, image.layer(indirect));
        return true;
    }

    void render_lanes(const PassContext& context, PassImage& image, MicroEyeTile& tile, const Lanes& lanes,
                      SharedPixels* shared) const {
        for (std::size_t lane = 0; lane < lanes.size(); ++lane)
            if (lanes[lane].x >= 0)
                tile.start(int(lane), make_eye_ray(scene_, options_, context, lanes[lane].x, lanes[lane].y));
            else
                tile.stop(int(lane));
        tile.run();
        for (std::size_t lane = 0; lane < lanes.size(); ++lane)
            if (const glm::ivec2 p = lanes[lane]; p.x >= 0) {
                store(tile.sum(int(lane)), image, p.x, p.y, false);
                if (shared) shared->set(p.x, p.y, tile.seen(int(lane)));
            }
    }

    const Scene& scene_;
    RenderOptions options_;
    MicroSettings settings_;
    gathering::SurfaceTriangles surfaces_;
    SharedCounters counters_;
    std::atomic<std::uint64_t> receivers_{0};
    std::uint64_t places_ = 0, light_points_ = 0, shaded_again_ = 0;
    std::size_t bytes_ = 0;
    double light_seconds_ = 0.0, gather_seconds_ = 0.0;
};

}  // namespace

std::unique_ptr<Estimator> make_micro_estimator(const Scene& scene, const RenderOptions& options,
                                                const MicroSettings& settings) {
    return std::make_unique<MicroEstimator>(scene, options, settings);
}

}  // namespace mote::integrators
