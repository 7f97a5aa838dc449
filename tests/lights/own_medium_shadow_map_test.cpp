// Shadow maps of a medium that is not part of the project: marched through its interface alone.
#include <cmath>

#include "core/formats/xml/scene_loader.h"
#include "core/math/random.h"
#include "core/objects/properties.h"
#include "core/scene/scene.h"
#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "media/phase_functions.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using lights::ShadowMapSettings, lights::ShadowMapView, lights::VolumetricShadowMap;

namespace {

/// Extinction in short waves along x, chromatic; it names a voxel size or none. `planted`: every part of a
/// march counts as if the extinction of its start continued, which is how such media were once mapped.
class Waves final : public Medium {
  public:
    Waves(float voxel_size, bool planted) : voxel_size_(voxel_size), planted_(planted) {}
    MediumTraits traits() const override {
        MediumTraits t;
        t.chromatic = true, t.voxel_size = voxel_size_;
        return t;
    }
    const PhaseFunction& phase() const override { return phase_; }
    MediumCoefficients coefficients(const Vec3& p) const override {
        MediumCoefficients c;
        c.sigma_t = (1.0f + std::sin(33.0f * p.x)) * Rgb(0.2f, 0.8f, 1.6f);
        return c;
    }
    float majorant() const override { return 3.2f; }
    Bounds3 bounds() const override { return {Vec3(-infinity), Vec3(infinity)}; }
    std::optional<float> sample_collision(const Ray&, PathWeights&, Rgb&, Rng&,
                                          TrackingCounters&) const override {
        return std::nullopt;
    }
    void connect(const Ray&, PathWeights&, Rng&, TrackingCounters&) const override {}
    Rgb transmittance(const Ray&, Rng&, TrackingCounters&) const override { return Rgb(1.0f); }

    void optical_depths_along(const Ray& ray, float voxels, std::span<Vec3d> depths,
                              TrackingCounters& counters) const override {
        if (!planted_) return Medium::optical_depths_along(ray, voxels, depths, counters);
        const float part = (ray.t_max - ray.t_min) / float(depths.size());
        Vec3d sum(0.0);
        for (std::size_t i = 0; i < depths.size(); ++i)
            depths[i] = sum += part * coefficients(ray.at(ray.t_min + float(i) * part)).sigma_t;
    }

  private:
    float voxel_size_;
    bool planted_;
    media::IsotropicPhase phase_;
};

/// A ball of radius 2 around the origin, filled with waves.
std::unique_ptr<Scene> ball_of_waves(float voxel_size, bool planted) {
    Registry registry = tests::registry();
    registry.add({Category::medium, "waves", "", {}, ""},
                 [=](const Properties&) { return std::make_shared<Waves>(voxel_size, planted); });
    return load_scene_from_string(R"(<scene version="3.0.0">
        <shape type="sphere"><float name="radius" value="2"/><bsdf type="null"/>
          <medium type="waves" name="interior"/></shape>
        <emitter type="point"><point name="position" x="3" y="0" z="0"/></emitter>
        <sensor type="perspective"/></scene>)",
                                  ".", registry);
}

/// Optical depth from a to b inside the ball.
Vec3d quadrature(const Medium& medium, const Vec3& a, const Vec3& b) {
    constexpr int steps = 4000;
    Vec3d sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const Vec3 p = a + (float(i) + 0.5f) / float(steps) * (b - a);
        if (glm::length(p) < 2.0f) sum += Vec3d(medium.coefficients(p).sigma_t);
    }
    return sum * (double(glm::distance(a, b)) / steps);
}

/// Relative rms error of the transmittance from a light outside of the ball.
double rms_error(float voxel_size, bool planted) {
    const auto scene = ball_of_waves(voxel_size, planted);
    const ShadowMapView view = ShadowMapView::of_point(Vec3(3.0f, 0.1f, 0.2f), 128);
    ShadowMapSettings settings;
    settings.intervals = 32;
    VolumetricShadowMap map;
    map.build(*scene, view, scene->medium_state_at(view.origin, nullptr), settings);
    Rng rng(5);
    double squares = 0.0;
    const int points = 1000;
    for (int i = 0; i < points; ++i) {
        const Vec3 p = 2.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 1.0f;
        const Vec3d depth = quadrature(*scene->media().front(), view.origin, p);
        const Rgb t = map.transmittance(p);
        for (int c = 0; c < 3; ++c)
            squares += std::pow(double(t[c]) / std::exp(-depth[c]) - 1.0, 2.0) / (3.0 * points);
    }
    return std::sqrt(squares);
}

}  // namespace

TEST_CASE("a shadow map of any medium that varies is its quadrature", "[shadow_map][marching]") {
    // Interpolation error between the ends of intervals: a wave's amplitude over its wave number.
    constexpr double limit = 0.03;
    CHECK(rms_error(infinity, false) < limit);
    CHECK(rms_error(0.02f, false) < limit);
    CHECK_FALSE(rms_error(infinity, true) < limit);
}
