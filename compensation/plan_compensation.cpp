#include "compensation/plan_compensation.h"

#include <fmt/format.h>

#include "compensation/bounded_geometry.h"
#include "compensation/expected_loss.h"
#include "core/math/random.h"

namespace mote::compensation {

using namespace core;

namespace {

std::string how(const CompensationSettings& s) {
    const std::string depth = s.depth < 0 ? "any number of steps" : fmt::format("{} step(s)", s.depth);
    return fmt::format("{}{}, {}", s.exact() ? "exact, " : "approximate, ", s.strategy_name(), depth);
}

const char* const all_steps = "integrator.compensation.depth=-1";
const char* const all_receivers = "integrator.compensation.receivers=all";

/// Simplifications, each with what it does to the mean.
void plan_simplifications(Plan& plan, const CompensationSettings& s) {
    if (s.depth >= 0)
        plan.miss("compensation", fmt::format("what needs more than {} step(s)", s.depth),
                  "the recursion is cut off (Engelhardt 2013, Sec. 10.2.1)", all_steps);
    if (!s.local_visibility)
        plan.miss("compensation", "surfaces near points in media, as reflectors and as obstacles",
                  "local_visibility is false (Engelhardt 2013, Sec. 10.2.4)",
                  "integrator.compensation.local_visibility=true");
    if (s.transmittance == LocalTransmittance::mean)
        plan.miss("compensation", "variation of the extinction inside the bounding region",
                  "the transmittance is that of the mean extinction (Engelhardt 2013, Sec. 10.2.2)",
                  "integrator.compensation.transmittance=exact");
}

/// True if any two of: surfaces, media, lie within `radius`, by the boxes of surfaces and media.
bool surface_within_reach(const Scene& scene, float radius) {
    for (const auto& medium : scene.media()) {
        const Bounds3 box = scene.medium_extent(*medium);
        if (box.empty()) continue;
        for (const auto& shape : scene.shapes()) {
            if (shape->bsdf->traits().null) continue;
            const Bounds3 other = shape->bounds();
            const Vec3 gap = glm::max(glm::max(box.lower - other.upper, other.lower - box.upper), Vec3(0.0f));
            if (glm::dot(gap, gap) <= radius * radius) return true;
        }
    }
    return false;
}

/// Extinction and scattering where light scatters: averages weighted with the extinction itself. The chord is
/// that of the largest medium's box.
ExpectedMedium typical_medium(const Scene& scene) {
    double sum = 0.0, squares = 0.0, scattering = 0.0, chord = 0.0;
    Rng rng(1);
    for (const auto& medium : scene.media()) {
        const Bounds3 all = scene.medium_extent(*medium), own = medium->bounds();
        const Bounds3 box{glm::max(all.lower, own.lower), glm::min(all.upper, own.upper)};
        if (box.empty() || !std::isfinite(box.radius())) continue;
        const Vec3d e(box.diagonal());
        const double surface = 2.0 * (e.x * e.y + e.y * e.z + e.z * e.x);
        if (surface > 0.0) chord = std::max(chord, 4.0 * e.x * e.y * e.z / surface);
        for (int i = 0; i < 4096; ++i) {
            const Vec3 u(rng.next_float(), rng.next_float(), rng.next_float());
            const MediumCoefficients c = medium->coefficients(box.lower + u * box.diagonal());
            const double t = double(average(c.sigma_t)), s = double(average(c.sigma_s));
            sum += t, squares += t * t, scattering += t * s;
        }
    }
    if (!(sum > 0.0)) return {};
    return {squares / sum, scattering / sum, chord};
}

}  // namespace

void plan_expected_loss(Plan& plan, const Scene& scene, int steps, float bound) {
    if (!scene.has_media() || !std::isfinite(bound)) return;
    const ExpectedMedium medium = typical_medium(scene);
    const double loss = expected_loss(medium, double(bound), steps);
    plan.run("expected loss", fmt::format("{:.2g} % of the light between points of the media", 100.0 * loss),
             fmt::format("beta^(k+1) / beta_all after k steps; beta = {:.2g}, beta_all = {:.2g} at sigma_t = "
                         "{:.3g} /m",
                         medium.beta(double(bound)), medium.beta_all(), medium.sigma_t));
    constexpr double target = 0.02;
    if (loss <= target) return;
    const double radius = double(scene.rays().bounds().radius());
    const auto suggestion = [&](int k) {
        const double b = bound_for_loss(medium, k, target);
        return fmt::format("{} step(s), bound {:.3g}, {:.0f} light paths", k, b,
                           std::ceil(b * radius * radius));
    };
    plan.run("for a loss of 2 %", suggestion(std::max(steps, 1)),
             "or " + suggestion(std::max(steps, 1) + 1) + "; paths as the automatic bound wants them");
}

void plan_compensation(Plan& plan, const Scene& scene, const Requirements& r, const CompensationSettings& s,
                       float bound) {
    if (!std::isfinite(bound)) {
        plan.leave_out("compensation", "all of it", "nothing bounds the geometry term here");
        return;
    }
    const float radius = bounding_radius(bound);
    plan.run("compensation", how(s), fmt::format("inside {:.4g} m of every receiver", radius));
    if (!r.any_media()) {
        plan.leave_out("compensation in media", "volume vertices, mean extinction", "there are no media");
        if (!s.surfaces)
            plan.miss("compensation", "everything", "only media are requested, and there are none",
                      all_receivers);
        if (s.depth >= 0)
            plan.miss("compensation", fmt::format("what needs more than {} step(s)", s.depth),
                      "the recursion is cut off (Engelhardt 2013, Sec. 10.2.1)", all_steps);
        return;
    }
    plan_simplifications(plan, s);
    if (!s.surfaces)
        plan.miss("compensation", "of light first scattered by surfaces", "receivers: media", all_receivers);
    if (!s.media)
        plan.miss("compensation", "of light first scattered in media", "receivers: surfaces", all_receivers);
    if (!surface_within_reach(scene, radius))
        plan.leave_out("surfaces in the compensation of media", "never met",
                       fmt::format("no surface lies within {:.4g} m of a medium", radius));
}

}  // namespace mote::compensation
