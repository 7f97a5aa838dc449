#include "core/render/cpu_clock.h"
#include "integrators/micro_rendering/micro_eye_tile.h"

namespace mote::integrators {

using namespace core;
namespace {

/// With the n texels i of a receiver's micro-buffer, each 1/n of its cosine square, and the nodes of points
/// that they see,
///   L(x) = pi / n sum_i f(x, w_i) L(node_i)    (Engelhardt 2013, Sec. 8.1.2),
/// of glossy receivers with the square warped by f. L of the points is that of gathering/stored_light; direct
/// light is sampled.
class MicroEstimator final : public Estimator {
  public:
    MicroEstimator(const Scene& scene, const RenderOptions& options, const MicroSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          loop_(scene, options,
                {.upsampling = settings.upsampling,
                 .upsampled = {{std::size_t(Transport::indirect), screenspace::LayerKind::surface}}}),
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
        const bool complete = loop_.run(context, image, {.limits = settings_.eye}, [&](EyeTask<false>& task) {
            MicroEyeTile tile(settings_, points, task.packet());
            task.for_each([&](const PacketPixels& pixels) { tile.run(pixels.gathers); });
            receivers_ += tile.receivers();
        });
        gather_seconds_ += process_cpu_seconds() - lit;
        return complete;
    }

    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
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
    }

  private:
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
        loop_.counters().add(cost.rays, cost.tracking);
        places_ += cost.places, light_points_ += cost.light_points, bytes_ = std::max(bytes_, cost.bytes);
        light_seconds_ += seconds;
    }

    const Scene& scene_;
    RenderOptions options_;
    MicroSettings settings_;
    ImageLoop<false> loop_;
    gathering::SurfaceTriangles surfaces_;
    std::atomic<std::uint64_t> receivers_{0};
    std::uint64_t places_ = 0, light_points_ = 0;
    std::size_t bytes_ = 0;
    double light_seconds_ = 0.0, gather_seconds_ = 0.0;
};

}  // namespace

std::unique_ptr<Estimator> make_micro_estimator(const Scene& scene, const RenderOptions& options,
                                                const MicroSettings& settings) {
    return std::make_unique<MicroEstimator>(scene, options, settings);
}

}  // namespace mote::integrators
