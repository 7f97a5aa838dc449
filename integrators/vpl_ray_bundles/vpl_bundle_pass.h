// What the pixels of a pass share: virtual point lights, their weights against bundles, and directions.
#pragma once

#include "core/render/integrator.h"
#include "core/scene/scene.h"
#include "integrators/vpl_ray_bundles/vpl_bundle_settings.h"
#include "lights/emitters/other_lights.h"

namespace mote::integrators {

struct VplBundlePass {
    lights::VplSet vpls;
    std::vector<float> rivals;  ///< a_j (gathering/eye_bundles/path_weights.h)
    gathering::BundlePass bundles;
    std::optional<lights::OtherLights> but_sky;  ///< where bundles find the sky's direct light

    /// Throws core::Cancelled.
    VplBundlePass(const core::LitScene& lit, const VplBundleSettings& settings,
                  const core::RenderOptions& options, const core::PassContext& context);
    VplBundlePass(const VplBundlePass&) = delete;
    VplBundlePass& operator=(const VplBundlePass&) = delete;

    /// M where glossy receivers have rays of their own, else 0.
    float own_rays() const { return bundles.own_rays ? bundles.samples.directions : 0.0f; }
    /// Whose direct light eye paths look for; null: all.
    const core::LitScene* eye_lights() const { return but_sky ? &*but_sky : nullptr; }
};

}  // namespace mote::integrators
