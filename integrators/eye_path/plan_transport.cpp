// What the plans of several integrators say of media, lights in them, and caustics.
#include <fmt/format.h>

#include "core/scene/scene.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

void plan_caustics(Plan& plan, const Scene& scene, const Requirements& r) {
    if (!r.any_delta()) return;
    bool hidden = false;
    for (const auto& emitter : scene.emitters()) hidden |= !emitter->traits().can_be_hit();
    if (hidden)
        plan.miss("caustics of point, spot and directional lights", "light that passes delta surfaces last",
                  "no path can hit these lights; mote_photon_map renders them");
    plan.run("caustics", "by chance only",
             "paths that reach a light through delta surfaces count when they hit it: expect noise, and use "
             "mote_photon_map or a bidirectional method where they matter");
}

void plan_medium_lights(Plan& plan, const Requirements& r) {
    if (r.lights_media > 0)
        plan.run(
            "emission of media", fmt::format("{} as lights", r.lights_media),
            "points of heterogeneous ones are drawn for receivers, weighed against walks that meet them; "
            "particles start in all of them");
}

void plan_media(Plan& plan, const Requirements& r) {
    if (!r.any_media()) {
        plan.leave_out("media", "no code for media runs", "the scene has none");
        return;
    }
    for (std::size_t i = 0; i < r.media_descriptions.size(); ++i) {
        plan.run("medium", r.media_descriptions[i], "in the scene");
        plan.run("transmittance", r.media_estimators[i], r.media_estimator_reasons[i]);
    }
    if (r.media_heterogeneous > 0)
        plan.run("distances", "delta tracking against the grid's majorants",
                 "unbiased in heterogeneous media");
    if (r.media_heterogeneous == 0)
        plan.leave_out("tracking", "no null collisions",
                       "every medium is homogeneous: distances are analytic");
    if (!r.media_emissive) plan.leave_out("volume emission", "not looked up", "no medium emits");
    if (!r.media_chromatic)
        plan.leave_out("spectral weights", "all channels alike", "extinction is grey in every medium");
}

}  // namespace mote::integrators
