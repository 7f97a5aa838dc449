// Light traced to the camera, with nothing but the two-way interfaces: emission, reverse transport at
// vertices, importance of the camera, splats. It must be the picture that `path` finds from the other end. No
// integrator of the scene language: bidirectional paths are to come.
#include "core/render/splat.h"
#include "lights/virtual_lights/light_path.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;
using core::Rgb;

namespace {

enum class Error { none, mode, clipping };  ///< what is planted

class LightTracer final : public core::Estimator {
  public:
    LightTracer(const core::Scene& scene, const core::RenderOptions& options, std::uint32_t paths,
                Error error)
        : scene_(scene), options_(options), error_(error) {
        settings_.paths = paths;
    }

    bool pass(const core::PassContext& pass, core::PassImage& image) override {
        for (std::uint32_t path = 0; path < settings_.paths; ++path) {
            core::Sampler sampler(options_.sampler, options_.seed, path, pass.index);
            core::WalkContext context;
            context.rng = core::Rng(core::hash_keys(options_.seed, pass.index, path));
            core::Rng lens(core::hash_keys(options_.seed, path, pass.index, 7));
            const auto visit = [&](const core::ScatteringVertex& vertex, const Rgb& alpha, int,
                                   const core::MediumState&) {
                connect(vertex, alpha, lens, pass.filter, image);
            };
            if (scene_.has_media())
                lights::follow_light_path<true>(scene_, settings_, sampler, context, visit);
            else
                lights::follow_light_path<false>(scene_, settings_, sampler, context, visit);
        }
        return true;
    }

  private:
    void connect(const core::ScatteringVertex& vertex, const Rgb& alpha, core::Rng& rng,
                 const core::PixelFilter& filter, core::PassImage& image) const {
        if (!vertex.connectable()) return;
        const auto s = scene_.camera().sample_importance(vertex.position, rng.next_vec2(), filter.radius());
        if (!s) return;
        const auto mode = error_ == Error::mode ? core::TransportMode::radiance : core::TransportMode::power;
        const Rgb f = vertex.eval_cos(s->wi, mode) * core::adjoint_correction(vertex, vertex.wo, s->wi);
        if (core::is_black(f)) return;
        const float near = error_ == Error::clipping ? 0.0f : s->t_min;
        const core::Ray ray{vertex.ray_origin(s->wi), s->wi, 0.0f, s->distance - near};
        if (scene_.rays().occluded(ray)) return;
        const Rgb light = alpha * f * transmittance(ray, rng);
        core::for_each_splat(
            filter, s->film_position, options_.width, options_.height,
            [&](int x, int y, float weight) { image.at(0, x, y) += light * (s->weight * weight); });
    }
    Rgb transmittance(const core::Ray& ray, core::Rng& rng) const {
        if (!scene_.has_media()) return Rgb(1.0f);
        core::TrackingCounters counters;
        return scene_.transmittance(ray.origin, ray.at(ray.t_max),
                                    scene_.medium_state_at(ray.origin, nullptr), rng, counters);
    }

    const core::Scene& scene_;
    core::RenderOptions options_;
    lights::LightPathSettings settings_;
    Error error_;
};

class LightTracing final : public core::Integrator {
  public:
    explicit LightTracing(std::uint32_t paths, Error error = Error::none) : paths_(paths), error_(error) {}
    std::string type() const override { return "light_tracing"; }
    std::vector<core::Layer> layers(const core::Scene&) const override { return {{"scattered", "", false}}; }
    core::Plan plan(const core::Scene&, const core::Requirements&) const override { return {}; }
    std::unique_ptr<core::Estimator> prepare(const core::Scene& scene,
                                             const core::RenderOptions& options) const override {
        return std::make_unique<LightTracer>(scene, options, paths_, error_);
    }

  private:
    std::uint32_t paths_;
    Error error_;
};

/// The three cameras, before the open side of the box. A pane stands between the near plane and the lens.
std::vector<std::string> sensors() {
    const std::string look = R"(<lookat origin="0.2, 0.1, 3.6" target="0, 0, 0" up="0, 1, 0"/>)";
    const std::string near = R"(<float name="near_clip" value="1.5"/>)";
    return {
        R"(<sensor type="perspective"><float name="fov" value="34"/><transform name="to_world">)" + look +
            "</transform>" + near + "</sensor>",
        R"(<sensor type="thinlens"><float name="fov" value="34"/><float name="aperture_radius" value="0.15"/>
                <float name="focus_distance" value="3"/><transform name="to_world">)" +
            look + "</transform>" + near + "</sensor>",
        R"(<sensor type="orthographic"><transform name="to_world"><scale x="0.9" y="0.9"/>)" + look +
            "</transform>" + near + "</sensor>"};
}

/// Walls of rough plastic, a ball of rough glass, and a pane that only the near plane hides from the camera.
std::string full_box() {
    std::string xml = box(mixed, "");
    xml.insert(xml.find("<sensor"), R"(
        <shape type="sphere"><point name="center" x="-0.35" y="-0.4" z="0.2"/><float name="radius" value="0.4"/>
            <bsdf type="roughdielectric"><float name="alpha" value="0.4"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="0.2"/><translate x="0.2" y="0.1" z="2.8"/>
            </transform><bsdf type="diffuse"/></shape>)");
    return xml;
}

}  // namespace

TEST_CASE("light traced to the camera is the picture of path", "[integrators][light_tracing][equality]") {
    const RenderSpec eye_spec{4, 800, 1, {{"scattered", {"direct", "indirect"}}}}, light_spec{4, 100, 2};
    for (const std::string& sensor : sensors()) {
        INFO(sensor);
        const auto scene = scene_from(with_sensor(full_box(), sensor));
        const auto eye =
            render_statistics(*scene, *integrator_from(R"(<integrator type="path"/>)"), eye_spec);
        const auto light = render_statistics(*scene, LightTracing(4000), light_spec);
        check_same_mean(light, "scattered", eye, "scattered", {1.04});
        CHECK(light.non_finite == 0);
        if (sensor != sensors().front()) continue;  // planted once
        const auto differs = [&](Error error) {
            const auto wrong = render_statistics(*scene, LightTracing(4000, error), light_spec);
            return !same_mean(wrong, "scattered", eye, "scattered", OnFailure::nothing).passed;
        };
        CHECK(differs(Error::mode));      // glass scales power as if it were radiance
        CHECK(differs(Error::clipping));  // what lies before the near plane casts its shadow
    }
}

TEST_CASE("light traced to the camera through fog is the picture of volpath",
          "[integrators][light_tracing][equality]") {
    const std::string hazy =
        box(mixed, fog("0.6, 0.9, 1.2", R"(<phase type="hg"><float name="g" value="0.6"/></phase>)"));
    const RenderSpec eye_spec{
        4, 800, 1, {{"scattered", {"direct", "indirect", "single_scattering", "multiple_scattering"}}}};
    const auto scene = scene_from(with_sensor(hazy, sensors()[1]));
    const auto eye = render_statistics(*scene, *integrator_from(R"(<integrator type="volpath"/>)"), eye_spec);
    const auto light = render_statistics(*scene, LightTracing(4000), {4, 100, 2});
    check_same_mean(light, "scattered", eye, "scattered", {1.04});
}

TEST_CASE("a plane in the sun is as bright from the sun's side", "[integrators][light_tracing]") {
    const std::string xml = R"(<scene version="3.0.0">
        <shape type="rectangle"><transform name="to_world"><scale value="2.5"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
        <emitter type="directional"><vector name="direction" x="0.6" y="0" z="-0.8"/>
            <rgb name="irradiance" value="3"/></emitter><sensor></sensor></scene>)";
    for (const std::string& sensor : sensors()) {
        INFO(sensor);
        const auto scene = scene_from(with_sensor(xml, sensor), 8);
        const auto light = render_statistics(*scene, LightTracing(8000), {4, 200, 3});
        const double radiance = 0.5 / 3.14159265358979 * 3.0 * 0.8;  // rho / pi E cos
        check_mean_is(light, "scattered", radiance, {1.03});
    }
}
