// `mote_vsl`: light from virtual spherical lights (Hasan et al. 2009), on surfaces.
//
// As `mote_vpl`: every pass traces a fresh set of light paths, leaves a VPL at each of their vertices, and
// gathers all of them at the first connectable vertex of every pixel's eye path; direct light is computed
// apart. Here every VPL is a sphere that reaches to its k-th nearest neighbour, so that nothing has to be
// bounded, also between glossy surfaces. In return light is blurred over the spheres: a bias that more passes
// do not reduce, since each has spheres of the same size; more light paths a pass do.
#include "compensation/spherical_lights.h"
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/register_parts.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::integrators {

using namespace core;
namespace {

struct VslSettings {
    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 256;
    compensation::SphericalGather gather;

    lights::LightPathSettings light_paths(const MemoryBudget& memory = {}) const {
        lights::LightPathSettings s;
        s.memory = memory, s.paths = paths, s.rr_depth = eye.rr_depth;
        s.max_vertices = eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 2);
        return s;
    }
};

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

class MoteVsl final : public Integrator {
  public:
    explicit MoteVsl(const VslSettings& settings) : settings_(settings) {
        settings_.eye.max_scatterings = 1;  // from then on spherical lights take over
    }

    std::string type() const override { return "mote_vsl"; }
    std::vector<Layer> layers(const Scene&) const override { return transport_layers(false, "_spherical"); }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        if (scene.has_media())
            throw InputError(
                "mote_vsl renders surfaces only, and the scene has media; volpath and mote_vpl render them");
        return std::make_unique<VslEstimator>(scene, options, settings_);
    }

  private:
    VslSettings settings_;
};

Plan MoteVsl::plan(const Scene& scene, const Requirements& r) const {
    const auto& gather = settings_.gather;
    Plan plan;
    plan.integrator = type();
    plan.run("light paths", std::to_string(settings_.paths) + " a pass", "a fresh set every pass");
    plan.run("radius",
             std::to_string(gather.radius_scale) + " times the distance to neighbour " +
                 std::to_string(gather.neighbours),
             "a light covers the disc that its neighbours leave to it");
    plan.run("directions", std::to_string(gather.samples) + " a light",
             r.any_glossy() ? "from the cone and from glossy BSDFs at both ends, balance heuristic"
                            : "from the cone: every surface is diffuse");
    if (gather.visibility == compensation::SphereVisibility::per_sample)
        plan.run("visibility", "a shadow ray a direction", "soft where a sphere is partly hidden");
    else
        plan.run("visibility", "a shadow ray to the centre of every sphere", "requested");
    plan_choice_of_lights(plan, scene);
    plan.miss("detail of indirect light", "blurred over the spheres",
              "more passes do not sharpen it, more light paths do");
    if (r.any_delta())
        plan.miss("caustics", "light that reaches a receiver through a delta surface",
                  "a VPL cannot be connected through mirrors and glass; volpath renders it");
    if (r.any_media())
        plan.miss("the whole picture", "refused: the scene has media",
                  "spherical lights are for surfaces; volpath and mote_vpl render media");
    else
        plan.leave_out("media", "no code for media runs", "the scene has none");
    return plan;
}

}  // namespace

void register_mote_vsl(Registry& registry) {
    using S = VslSettings;
    using Gather = compensation::SphericalGather;
    using compensation::SphereVisibility;
    add_type<S>(
        registry, Category::integrator, "mote_vsl",
        "Virtual spherical lights (Hasan et al. 2009), for scenes without media: no splotches between "
        "glossy surfaces, and nothing bounded, but indirect light is blurred over the spheres. More "
        "passes remove noise only; the blur shrinks with more light paths a pass.",
        {within(&S::eye, eye_path_rows()),
         row("paths", &S::paths, between(0, 1 << 26), "Light paths traced in every pass."),
         within(&S::gather,
                row("neighbours", &Gather::neighbours, between(1, 1000),
                    "k: a sphere reaches to the k-th nearest other light of its pass."),
                row("radius_scale", &Gather::radius_scale, between(0, 1e6),
                    "Factor on the radius; 0: points, as mote_vpl without a bound."),
                row("samples", &Gather::samples, between(1, 4096), "Directions a light, for every receiver."),
                row("visibility", &Gather::visibility,
                    {{"sample", SphereVisibility::per_sample}, {"light", SphereVisibility::per_light}},
                    "sample: a shadow ray along every direction, up to the sphere; light: one to the "
                    "centre, faster with shadow edges as hard as a point's."))},
        R"(<integrator type="mote_vsl"><integer name="paths" value="512"/></integrator>)",
        [](const S& s) { return std::make_shared<MoteVsl>(s); });
}

}  // namespace mote::integrators
