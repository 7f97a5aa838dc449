#include "integrators/virtual_point_lights/plan_selection.h"

#include <fmt/format.h>

#include "core/scene/scene.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Nanoseconds of a shadow ray in a packet, as brute force spends them: for an estimate of its time.
constexpr double ray_nanoseconds = 60.0;
// Measured (docs/methods/many_lights.md), each between two numbers of VPLs of which one was tried.
constexpr double few_lights = 500.0;   // a cut evaluates as many
constexpr double some_lights = 1e4;    // 64 samples leave more error than their gather saves
constexpr double few_seconds = 1.0;    // of brute force: not worth an error
constexpr double patience = 30.0;      // seconds of brute force without a warning
constexpr double media_decide = 0.45;  // optical depth: the smoke room has 0.57, the atrium 0.34

double rays_of(const GatherSize& size) { return size.vpls * size.receivers * size.points; }
double seconds_of(const GatherSize& size) { return rays_of(size) * ray_nanoseconds * 1e-9; }

struct Advice {
    std::string best, why;
};

/// In media near VPLs matter, which bounds find; on surfaces visibility does, which sampling learns.
Advice recommended(const GatherSize& size) {
    if (size.vpls < few_lights)
        return {"all", fmt::format("{:.0f} VPLs are fewer than a hierarchy would evaluate", size.vpls)};
    const double rays = rays_of(size), seconds = seconds_of(size);
    const std::string cost = fmt::format(
        "all of about {:.2g} VPLs at {:.2g} receivers are {:.2g} shadow rays, {:.2g} s of processor time",
        size.vpls, size.receivers * size.points, rays, seconds);
    if (seconds < few_seconds) return {"all", cost + ": a selection saves less than it errs"};
    if (size.filtered)
        return {"resampling, 16 of 256 candidates, with interleaving 4",
                cost + "; each pixel chooses its own VPLs, so the filter removes their noise"};
    if (size.depth >= media_decide)
        return {"multidimensional_lightcuts with shared_angle 0.2",
                cost + fmt::format(
                           "; in media of optical depth {:.2g} most VPLs are visible and near ones matter, "
                           "which bounds find; points along a ray share a cut",
                           size.depth)};
    return {
        size.vpls < some_lights ? "stochastic_lightcuts, 64 samples" : "stochastic_lightcuts, 256 samples",
        cost + "; where surfaces hide most VPLs, sampling learns which clusters are visible"};
}

/// Where lines are better lights than points.
void plan_ray_lights(Plan& plan, const GatherSize& size) {
    if (size.depth < media_decide) return;
    plan.run(
        "integrator for this medium", "mote_ray_lights",
        fmt::format("optical depth {:.2g}: segments of light paths need no bound in media; in {} they took "
                    "{} of the time of bounded VPLs with compensation to 5 % of error",
                    size.depth, size.homogeneous ? "homogeneous fog" : "smoke",
                    size.homogeneous ? "a tenth" : "a third"));
}

/// Mean optical depth of lines through the box along an axis.
double depth_along(const Medium& medium, const Bounds3& box, int axis) {
    constexpr int side = 4;
    TrackingCounters counters;
    Ray ray;
    ray.direction = Vec3(0.0f), ray.direction[axis] = 1.0f, ray.t_max = box.diagonal()[axis];
    double sum = 0.0;
    for (int i = 0; i < side * side; ++i) {
        Vec3 u(0.0f);
        u[(axis + 1) % 3] = (float(i % side) + 0.5f) / float(side);
        u[(axis + 2) % 3] = (float(i / side) + 0.5f) / float(side);
        ray.origin = box.lower + u * box.diagonal();
        const Vec3d depth = medium.optical_depth_along(ray, 1.0f, counters);
        sum += (depth.x + depth.y + depth.z) / (3.0 * double(side * side));
    }
    return sum;
}

}  // namespace

double depth_of_media(const Scene& scene) {
    double sum = 0.0;
    for (const auto& medium : scene.media()) {
        if (!medium->traits().scattering || medium->traits().empty) continue;
        Bounds3 box = scene.medium_extent(*medium);
        const Bounds3 all = scene.bounds();
        box.lower = glm::max(box.lower, all.lower), box.upper = glm::min(box.upper, all.upper);
        if (glm::any(glm::lessThanEqual(box.diagonal(), Vec3(0.0f)))) continue;
        for (int axis = 0; axis < 3; ++axis) sum += depth_along(*medium, box, axis) / 3.0;
    }
    return sum;
}

void plan_selection_advice(Plan& plan, const GatherSize& size) {
    const auto [best, why] = recommended(size);
    plan.run("selection for this scene", best, why);
    plan_ray_lights(plan, size);
}

void warn_of_long_passes(Plan& plan, const GatherSize& size) {
    if (seconds_of(size) < patience) return;
    plan.costly.push_back(
        fmt::format("a pass is about {:.2g} shadow rays, {:.0f} s of processor time at the least, several "
                    "times as many in media that "
                    "vary: fewer paths a pass, or the selection {}",
                    rays_of(size), seconds_of(size), recommended(size).best));
}

}  // namespace mote::integrators
