// Algorithms over the callbacks of a scene outside of mote, and over plain arrays, each against a
// closed form: gathering by rays and by imperfect shadow maps, choosing lights, ray-bundles, marching along
// eye rays, screen-space compensation, regression. Linked without anything that reads files (see
// CMakeLists.txt).
#include <cstdio>
#include <numeric>

#include "core/scene/callback_scene.h"
#include "core/scene/camera.h"
#include "core/scene/light_tree.h"
#include "gathering/ray_bundles/bundle_tracer.h"
#include "gathering/ray_bundles/triangle_list.h"
#include "lights/emitters/emitters.h"
#include "lights/imperfect_shadow_maps/imperfect_visibility.h"
#include "lights/imperfect_shadow_maps/surface_samples.h"
#include "screenspace/denoising/block_regression.h"
#include "screenspace/in_scattering/airlight.h"
#include "screenspace/in_scattering/in_scattering_rays.h"
#include "screenspace/ssbc/ssbc.h"
#include "tests/support/analytic_scene.h"

using namespace mote;
using core::Bounds3, core::Ray, core::Rgb, core::Vec2, core::Vec3;
using tests::AnalyticScene, tests::FloorUnderLight;

namespace {

int failures = 0;

void expect(bool holds, const char* what, double value) {
    std::printf("%-66s %.3g%s\n", what, value, holds ? "" : "   WRONG");
    failures += !holds;
}

/// The formulas of another scene, through functions.
core::CallbackScene callbacks_of(const AnalyticScene& scene) {
    return core::CallbackScene(
        {.first_hit = [&](const Ray& ray) { return scene.first_hit(ray); },
         .transmittance = [&](const Vec3& a, const Vec3& b) { return scene.through_fog(a, b); },
         .bounds = scene.bounds()});
}

void gather_light() {
    const AnalyticScene formulas(Rgb(0.3f, 0.6f, 1.2f));
    const core::CallbackScene scene = callbacks_of(formulas);
    FloorUnderLight at(formulas);
    const auto scratch = std::make_unique<lights::GatherScratch>();
    core::RayCounters rays;
    core::TrackingCounters tracking;
    const lights::GatherContext context{scene, *scratch, rays, tracking};
    const lights::BoundedGeometry unbounded{core::infinity};
    const auto light = lights::gather(context, at.vpls, lights::VplRange{}, unbounded, at.tile);
    const double error = double(FloorUnderLight::largest_error(formulas, light));
    expect(error < 1e-5, "light by rays over callbacks, largest relative error", error);

    const auto points = lights::sample_surfaces(scene, 65536, 1);
    lights::ImperfectShadowMaps maps;
    maps.build(points, at.vpls, {.size = 64, .points = 65536}, 1);
    lights::ImperfectVisibility visibility(context, at.tile, maps);
    const auto by_maps =
        lights::gather_with(context, at.vpls, lights::VplRange{}, unbounded, at.tile, visibility);
    int wrong = 0;  // lit or dark, where the ball's edge is more than a texel away
    for (int i = 0; i < lights::ReceiverLanes::width; ++i) {
        const bool lit = by_maps[std::size_t(i)].x > 0.0f;
        wrong += lit != formulas.free_of_ball(FloorUnderLight::receiver(i), FloorUnderLight::light);
    }
    expect(wrong <= 1, "receivers of 16 that imperfect shadow maps light wrongly", wrong);
}

void choosing_lights() {
    std::vector<std::shared_ptr<core::Emitter>> emitters;
    std::vector<core::LightBounds> bounds;
    for (int i = 0; i < 37; ++i) {
        emitters.push_back(lights::make_point_light({i, i % 5, 2.0}, Rgb(float(1 + i % 3))));
        bounds.push_back(*emitters.back()->bounds());
    }
    const core::LightTree tree(bounds);
    const core::LightReceiver receiver{{3.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    double sum = 0.0, off = 0.0;
    for (std::uint32_t i = 0; i < emitters.size(); ++i) sum += tree.probability(receiver, i);
    for (double u = 0.01; u < 1.0; u += 0.01) {
        const auto choice = tree.sample(receiver, u);
        off = std::max(off, std::fabs(choice.probability - tree.probability(receiver, choice.light)));
    }
    expect(std::fabs(sum - 1.0) < 1e-6 && off < 1e-6, "probabilities of a light hierarchy add up to", sum);

    const auto nothing = [](const core::Ray&) { return std::optional<core::SurfaceHit>(); };
    const core::CallbackScene scene(
        {.first_hit = nothing, .emitters = emitters, .bounds = {Vec3(0.0f), Vec3(40.0f)}});
    double by_power = 0.0;
    for (const auto& e : scene.emitters()) by_power += double(scene.light_probability(receiver, e.get()));
    expect(std::fabs(by_power - 1.0) < 1e-6, "probabilities of a scene of callbacks add up to", by_power);
}

/// Two unit squares face each other: parallel rays across them link the fraction that a slant leaves.
void bundles() {
    gathering::SurfaceTriangles surfaces;
    for (const float z : {0.0f, 1.0f}) {
        gathering::TriangleList list(surfaces, std::uint32_t(z));
        const auto corner = [&](float x, float y) {
            return gathering::TriangleList::Corner{{x, y, z}, {}, {}};
        };
        const bool up = z == 0.0f;  // fronts towards each other
        list.add(corner(0, 0), up ? corner(1, 0) : corner(1, 1), up ? corner(1, 1) : corner(1, 0), 0);
        list.add(corner(0, 0), up ? corner(1, 1) : corner(0, 1), up ? corner(0, 1) : corner(1, 1), 1);
    }
    surfaces.bounds = {Vec3(0.0f), Vec3(1.0f)};
    const gathering::BundleTracer tracer(surfaces);
    const Vec3 direction = glm::normalize(Vec3(0.25f, 0.0f, 1.0f));
    const auto grid = gathering::bundle_grid(direction, surfaces.bounds, 1.0f / 512.0f, Vec2(0.5f));
    double area = 0.0;
    gathering::for_each_link(tracer.trace(grid),
                             [&](auto, const auto&, const auto&) { area += double(grid.ray_area()); });
    const double expected = 0.75 * double(direction.z);  // of [0, 1 - 0.25] x [0, 1], seen along the rays
    expect(std::fabs(area / expected - 1.0) < 0.01, "linked area of a ray-bundle over its closed form",
           area / expected);
}

/// Looks along +z from the origin, a unit of film a metre at distance 1.
struct Pinhole final : core::Camera {
    Ray sample_ray(const Vec2& film, const Vec2&) const override {
        return {Vec3(0.0f), glm::normalize(Vec3(film, 1.0f))};
    }
    core::CameraTraits traits() const override { return {true, false}; }
    std::optional<core::RayImportance> importance(const Vec3&, const Vec3&, float) const override {
        return {};
    }
    std::optional<core::CameraSample> sample_importance(const Vec3&, const Vec2&, float) const override {
        return {};
    }
    Vec3 position() const override { return Vec3(0.0f); }
    core::Transform to_world() const override { return {}; }
};

void marching() {
    const float sigma_t = 0.3f, sigma_s = 0.2f, wall = 4.0f;
    const core::ForeignSurface surface(core::make_diffuse(core::make_constant_texture(Rgb(0.5f))));
    const auto fog = std::make_shared<media::HomogeneousMedium>(Rgb(sigma_t), Rgb(sigma_s), Rgb(0.0f),
                                                                std::make_shared<media::IsotropicPhase>());
    const Vec3 lamp{0.5f, 0.2f, 2.0f};
    const auto hit_wall = [&](const Ray& ray) -> std::optional<core::SurfaceHit> {
        const float t = (wall - ray.origin.z) / ray.direction.z;
        if (!(t > ray.t_min && t < ray.t_max)) return {};
        return surface.hit(ray, t, {0.0f, 0.0f, -1.0f});
    };
    const core::CallbackScene scene({.first_hit = hit_wall,
                                     .medium = fog,
                                     .emitters = {lights::make_point_light(core::Vec3d(lamp), Rgb(2.0f))},
                                     .bounds = {Vec3(-4.0f), Vec3(4.0f)}});
    const Pinhole camera;
    const screenspace::InScattering light(scene, scene.bounds(), *scene.emitters()[0], {.steps = 256});
    const screenspace::InScatteringRays source(
        scene, {camera, [&](const Ray&) { return scene.medium_state(); }}, light, Vec2(0.5f));
    const auto task = source.start();
    double worst = 0.0;
    for (const glm::dvec2& film : {glm::dvec2(0.0, 0.0), glm::dvec2(0.2, 0.1), glm::dvec2(-0.4, 0.3)}) {
        const auto end = task->end_of(film);
        const Ray ray = task->ray(film);
        const screenspace::PassingRay passing(ray, lamp);
        const double expected =
            2.0 * double(sigma_s) *
            screenspace::airlight(passing, 0.0, double(wall / ray.direction.z), double(sigma_t), 0.0);
        worst = std::max(worst, std::fabs(double(task->march(film, end).radiance.x) / expected - 1.0));
    }
    expect(worst < 1e-3, "light scattered into eye rays, largest relative error", worst);
}

void pictures() {
    const int width = 64, height = 64;
    screenspace::SsbcSurfaces surfaces(width, height);
    for (int i = 0; i < width * height; ++i) {  // a floor of 0.1 m patches: nothing faces anything
        const Vec3 p{0.1f * float(i % width), 0.1f * float(i / width), 0.0f};
        surfaces.set(std::size_t(i), p, {0, 0, 1}, Vec3(3.0f, 3.0f, 5.0f) - p, 0.01f, Rgb(0.5f));
    }
    const std::vector<Rgb> grey(surfaces.pixel_count(), Rgb(1.0f));
    const auto added = screenspace::compensate(surfaces, grey, {.bound = 1.0f}).compensation;
    double most = 0.0;
    for (const Rgb& c : added) most = std::max(most, double(core::max_component(c)));
    expect(most < 1e-6, "what a plane compensates for itself", most);

    std::vector<float> feature(grey.size());
    std::vector<Rgb> noisy(grey.size());
    core::Rng rng(3);
    for (std::size_t i = 0; i < noisy.size(); ++i) {
        feature[i] = float(i % width) / float(width);
        noisy[i] = Rgb(feature[i] + 1.0f + 0.5f * (rng.next_float() - 0.5f));
    }
    const screenspace::FeaturePlane plane{feature};
    const auto fit = screenspace::block_regression(width, height, {&plane, 1}, noisy, {});
    double before = 0.0, after = 0.0;
    for (std::size_t i = 0; i < noisy.size(); ++i) {
        before += std::pow(double(noisy[i].x - feature[i] - 1.0f), 2.0);
        after += std::pow(double(fit.colour[i].x - feature[i] - 1.0f), 2.0);
    }
    // A fit of three numbers (1, the feature, noise of the features) to 1024 pixels keeps about 3 / 1024 of
    // the variance.
    expect(after / before < 0.02, "fraction of the variance that a regression on the truth keeps",
           after / before);
}

}  // namespace

int main() {
    gather_light(), choosing_lights(), bundles(), marching(), pictures();
    return failures == 0 ? 0 : 1;
}
