// Shared by the pixels of a pass: virtual point lights, their weights against bundles, and directions.
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
    /// By place in a block of interleaved pixels, y after x.
    std::vector<std::vector<gathering::BundleDirection>> lines;
    std::vector<gathering::RayBundle> kept;      ///< imperfect bundles of all lines, where they are looked up
    std::optional<lights::OtherLights> but_sky;  ///< where bundles find the sky's direct light

    /// `links`: null where rays are traced. Throws core::Cancelled; InputError where kept bundles exceed
    /// their budget.
    VplBundlePass(const core::LitScene& lit, const VplBundleSettings& settings,
                  const gathering::ImperfectLinks* links, const core::RenderOptions& options,
                  const core::PassContext& context);
    VplBundlePass(const VplBundlePass&) = delete;
    VplBundlePass& operator=(const VplBundlePass&) = delete;

    /// M where glossy receivers have rays of their own, else 0.
    float own_rays() const { return bundles.own_rays ? bundles.samples.directions : 0.0f; }
    std::size_t kept_bytes() const {
        std::size_t sum = 0;
        for (const auto& bundle : kept) sum += bundle.memory_bytes();
        return sum;
    }
    /// Lights whose direct light eye paths sample; null: all.
    const core::LitScene* eye_lights() const { return but_sky ? &*but_sky : nullptr; }

  private:
    void draw_lines(const VplBundleSettings& settings, const core::RenderOptions& options,
                    const core::PassContext& context);
    void keep_links(const core::RenderOptions& options, const core::PassContext& context);
};

}  // namespace mote::integrators
