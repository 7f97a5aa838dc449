#include "integrators/plan_compensation.h"

#include <fmt/format.h>

#include "compensation/bounded_geometry.h"

namespace mote::integrators {

using namespace core;
using compensation::CompensationSettings, compensation::LocalTransmittance, compensation::Placement;

namespace {

std::string how(const CompensationSettings& s) {
    const std::string depth = s.depth < 0 ? "any number of steps" : fmt::format("{} step(s)", s.depth);
    return fmt::format("{}{}, {}", s.exact() ? "exact, " : "approximate, ", s.strategy_name(), depth);
}

/// Simplifications, each with what it does to the mean.
void plan_simplifications(Plan& plan, const CompensationSettings& s) {
    if (s.depth >= 0)
        plan.miss("compensation", fmt::format("what needs more than {} step(s)", s.depth),
                  "the recursion is cut off (Engelhardt 2013, Sec. 10.2.1)");
    if (!s.local_visibility)
        plan.miss("compensation", "surfaces near points in media, as reflectors and as obstacles",
                  "local_visibility is false (Engelhardt 2013, Sec. 10.2.4)");
    if (s.transmittance == LocalTransmittance::mean)
        plan.miss("compensation", "variation of the extinction inside the bounding region",
                  "the transmittance is that of the mean extinction (Engelhardt 2013, Sec. 10.2.2)");
}

/// Do any two of: surfaces, media, lie within `radius`? Judged by the boxes of surfaces and media.
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

}  // namespace

void plan_compensation(Plan& plan, const Scene& scene, const Requirements& r, const CompensationSettings& s,
                       float bound) {
    if (!std::isfinite(bound)) {
        plan.leave_out("compensation", "all of it", "nothing bounds the geometry term here");
        return;
    }
    const float radius = compensation::bounding_radius(bound);
    plan.run("compensation", how(s), fmt::format("inside {:.4g} m of every receiver", radius));
    if (!r.any_media()) {
        plan.leave_out("compensation in media", "volume vertices, mean extinction", "there are no media");
        if (!s.surfaces)
            plan.miss("compensation", "everything", "only media are asked for, and there are none");
        if (s.depth >= 0)
            plan.miss("compensation", fmt::format("what needs more than {} step(s)", s.depth),
                      "the recursion is cut off (Engelhardt 2013, Sec. 10.2.1)");
        return;
    }
    plan_simplifications(plan, s);
    if (!s.surfaces) plan.miss("compensation", "of light first scattered by surfaces", "receivers: media");
    if (!s.media) plan.miss("compensation", "of light first scattered in media", "receivers: surfaces");
    if (!surface_within_reach(scene, radius))
        plan.leave_out("surfaces in the compensation of media", "never met",
                       fmt::format("no surface lies within {:.4g} m of a medium", radius));
}

}  // namespace mote::integrators
