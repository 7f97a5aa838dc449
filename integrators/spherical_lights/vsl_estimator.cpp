#include "integrators/eye_path/image_loop.h"
#include "integrators/spherical_lights/vsl_settings.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::integrators {

using namespace core;
namespace {

/// The lights of one pass.
struct SphereSet {
    lights::VplSet vpls;
    std::vector<float> radii;

    SphereSet(const Scene& scene, const VslSettings& settings, const RenderOptions& options,
              std::uint32_t pass, CancelToken cancelled)
        : vpls(lights::trace_light_paths(scene, settings.light_paths(options.memory), options.seed, pass,
                                         options.sampler, cancelled)),
          radii(compensation::sphere_radii(vpls, settings.gather.neighbours, settings.gather.radius_scale)) {}
    std::size_t memory_bytes() const { return vpls.memory_bytes() + radii.size() * sizeof(float); }
};

/// The spheres j of a pass, of radius r_j around VPLs y_j that received the power alpha_j, give a receiver x
///   L(x) = sum_j alpha_j / (pi r_j^2) int_cone f(x, wo, w) |cos_x| f(y_j, w_j, -w) |cos_y| dw
/// (Hasan et al. 2009); compensation/spherical_lights.h samples the integral.
class VslEstimator final : public Estimator {
  public:
    VslEstimator(const Scene& scene, const RenderOptions& options, const VslSettings& settings)
        : scene_(scene), options_(options), settings_(settings), loop_(scene, options) {
        settings_.eye.wanted = options.cells;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        const SphereSet spheres(scene_, settings_, options_, context.index, context.cancelled);
        loop_.counters().add(spheres.vpls.rays, spheres.vpls.tracking);
        vpls_ += spheres.radii.size(), paths_ += spheres.vpls.paths;
        bytes_ = std::max(bytes_, spheres.memory_bytes());
        for (const float r : spheres.radii) radius_sum_ += double(r);
        return loop_.run(context, image, {.limits = settings_.eye}, [&](EyeTask<false>& task) {
            EyePacket<false>& packet = task.packet();
            task.for_each([&](const PacketPixels&) {
                packet.run([&] {
                    packet.sample_lights();
                    packet.for_each([&](int, auto& lane) {
                        if (lane.alive && lane.path->vertex().connectable() &&
                            settings_.eye.wanted[Transport::indirect])
                            lane.sum[Transport::indirect] +=
                                lane.path->throughput() *
                                gather(lane.path->vertex(), lane.path->depth(), spheres, task.walk());
                    });
                });
            });
        });
    }

    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        statistics.values["vpls"] += double(vpls_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["vpl_bytes_peak"] = double(bytes_);
        if (vpls_ > 0) statistics.values["sphere_radius_mean"] = radius_sum_ / double(vpls_);
    }

  private:
    Rgb gather(const ScatteringVertex& vertex, int depth, const SphereSet& spheres, WalkContext& walk) const {
        return compensation::gather_spheres(scene_, spheres.vpls, spheres.radii, settings_.gather, vertex,
                                            settings_.eye.light_depth(depth), walk.rng, walk.rays);
    }

    const Scene& scene_;
    RenderOptions options_;
    VslSettings settings_;
    ImageLoop<false> loop_;
    std::uint64_t vpls_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
    double radius_sum_ = 0.0;
};

}  // namespace

std::unique_ptr<Estimator> make_vsl_estimator(const Scene& scene, const RenderOptions& options,
                                              const VslSettings& settings) {
    return std::make_unique<VslEstimator>(scene, options, settings);
}

}  // namespace mote::integrators
