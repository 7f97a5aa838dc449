// A plugin with an integrator: direct light, and ambient occlusion in place of indirect light (Landis 2002).
//
//   mote render scene.xml --plugin my_integrator.so --integrator my_ambient_occlusion -D
//   integrator.distance=0.5
//
// The radiance of an even sky that arrives at x where nothing within `distance` is in the way,
//   L = integral over the hemisphere of f*(x) A V(x, w) dw,
// is estimated with one direction of the BSDF a pass: A V f* / pdf.
#include <mote/core/objects/plugin.h>
#include <mote/core/parameters/add_type.h>
#include <mote/integrators/eye_path/eye_path_parameters.h>
#include <mote/integrators/eye_path/image_loop.h>

using namespace mote;
using core::Rgb, core::Transport;

namespace {

struct Settings {
    integrators::EyePathLimits eye;
    float distance = 1.0f;
    Rgb ambient{0.1f};
};

class AmbientOcclusion final : public core::Estimator {
  public:
    AmbientOcclusion(const core::Scene& scene, const core::RenderOptions& options, const Settings& settings)
        : scene_(scene), settings_(settings), loop_(scene, options) {
        settings_.eye.max_scatterings = 1;  // the last direction finds lights, as the other technique
    }

    bool pass(const core::PassContext& context, core::PassImage& image) override {
        return loop_.run(context, image, {settings_.eye}, [&](integrators::EyeTask<false>& task) {
            integrators::EyePacket<false>& packet = task.packet();
            const auto step = [&] {
                packet.sample_lights();
                packet.for_each([&](int, auto& lane) {
                    if (lane.alive && lane.path->scatterings() == 0)
                        lane.sum[Transport::indirect] += ambient_at(*lane.path, task.walk());
                });
            };
            task.for_each([&](const integrators::PacketPixels&) { packet.run(step); });
        });
    }
    void add_statistics(core::Statistics& statistics) const override { loop_.add_statistics(statistics); }

  private:
    Rgb ambient_at(integrators::EyePath<false>& path, core::WalkContext& walk) const {
        const core::ScatteringVertex& vertex = path.vertex();
        const float lobe = path.sampler().next_2d().x;
        const auto next = vertex.sample(lobe, path.sampler().next_2d(), core::TransportMode::radiance);
        if (!next || next->delta) return Rgb(0.0f);
        const core::Ray ray{vertex.ray_origin(next->wi), next->wi, 0.0f, settings_.distance};
        ++walk.rays.occlusion;
        return scene_.visible(ray) ? path.throughput() * next->weight * settings_.ambient : Rgb(0.0f);
    }

    const core::Scene& scene_;
    Settings settings_;
    integrators::ImageLoop<false> loop_;
};

class AmbientOcclusionIntegrator final : public core::Integrator {
  public:
    explicit AmbientOcclusionIntegrator(const Settings& settings) : settings_(settings) {}
    std::string type() const override { return "my_ambient_occlusion"; }
    std::vector<core::Layer> layers(const core::Scene&) const override {
        return integrators::transport_layers(false, "_ambient");
    }
    core::Plan plan(const core::Scene&, const core::Requirements& requirements) const override {
        core::Plan plan;
        plan.integrator = type();
        plan.run("ambient occlusion", "one direction per pixel and pass", "in place of indirect light");
        if (requirements.any_media()) plan.miss("media", "not rendered", "surfaces only");
        return plan;
    }
    std::unique_ptr<core::Estimator> prepare(const core::Scene& scene,
                                             const core::RenderOptions& options) const override {
        return std::make_unique<AmbientOcclusion>(scene, options, settings_);
    }

  private:
    Settings settings_;
};

void register_types(core::Registry& registry) {
    core::add_type(registry, core::Category::integrator, "my_ambient_occlusion",
                   "Direct light, and ambient occlusion in place of indirect light.",
                   core::ParameterList<Settings>{
                       core::within(&Settings::eye, integrators::eye_path_rows()),
                       core::row("distance", &Settings::distance, core::above(0, "m"),
                                 "Surfaces farther away do not occlude."),
                       core::row("ambient", &Settings::ambient, "Radiance of what is not occluded.")},
                   R"(<integrator type="my_ambient_occlusion"/>)",
                   [](const Settings& s) { return std::make_shared<AmbientOcclusionIntegrator>(s); });
}

}  // namespace

MOTE_PLUGIN(register_types)
