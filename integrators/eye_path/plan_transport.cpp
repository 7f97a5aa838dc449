// Plan entries on lights, media, lights in them, and caustics that several integrators share.
#include <fmt/format.h>

#include "core/scene/light_tree.h"
#include "core/scene/scene.h"
#include "integrators/eye_path/light_samples.h"
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

void plan_choice_of_lights(Plan& plan, const Scene& scene) {
    const std::size_t in_tree = scene.light_tree().size(), all = scene.emitters().size();
    if (all < 2) return;
    const std::string others =
        in_tree < all ? fmt::format("{} without a place, at infinity or in media, by power", all - in_tree)
                      : "";
    if (in_tree < 2)
        plan.run("choice of lights", in_tree ? others + ", against the other one" : others,
                 "half by power, half equally: receivers make no difference");
    else
        plan.run("choice of lights",
                 fmt::format("hierarchy of {} lights, {} deep{}", in_tree, scene.light_tree().depth(),
                             others.empty() ? "" : "; " + others),
                 "each receiver samples one by distance, directions and intensity; one in 16 by power, for "
                 "what the hierarchy does not see");
}

void plan_samples_of_lights(Plan& plan, const Scene& scene) {
    const LightSamples samples = light_samples_for(scene);
    if (samples.at_most() == 1) return;
    const std::string in_media = scene.has_media() ? fmt::format(", {} in media", samples.media) : "";
    plan.run("samples of lights",
             fmt::format("{} on surfaces{}, at the first two vertices of a path", samples.surfaces, in_media),
             samples.media < samples.surfaces
                 ? "shadow rays take little time; in media transmittance would have to be looked up"
                 : "shadow rays take little time");
}

void plan_medium_lights(Plan& plan, const Requirements& r) {
    if (r.lights_media > 0)
        plan.run(
            "emission of media", fmt::format("{} as lights", r.lights_media),
            "points of heterogeneous ones are sampled for receivers, weighted against walks that meet them; "
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
