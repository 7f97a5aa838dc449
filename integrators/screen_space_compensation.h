// Screen-space bias compensation at the end of a render (Engelhardt 2013, Ch. 11), for the light that
// surfaces reflect; light first scattered in media may be compensated by another method in the passes: the
// combination that Sec. 10.6 names as future work.
#pragma once

#include "compensation/compensation_settings.h"
#include "core/image/film.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "screenspace/ssbc.h"

namespace mote::integrators {

/// A nested <compensation type="screen_space"> of a scene file.
class ScreenSpaceCompensation : public core::Object {
  public:
    ScreenSpaceCompensation(screenspace::SsbcSettings settings, compensation::CompensationSettings media)
        : settings_(settings), media_(media) {}
    const screenspace::SsbcSettings& settings() const { return settings_; }
    /// Of receivers in media alone.
    const compensation::CompensationSettings& media() const { return media_; }

  private:
    screenspace::SsbcSettings settings_;
    compensation::CompensationSettings media_;
};

struct ScreenSpaceCost {
    std::uint64_t samples = 0;  ///< nodes of the hierarchy and pixels that were added up
    double seconds = 0.0;       ///< G-buffer and all steps
};

/// Fills layer `target` of the film with what the bound took from the layers `reflected`: light that surfaces
/// send to the eye, direct and indirect.
ScreenSpaceCost add_screen_space_compensation(const core::Scene& scene,
                                              const screenspace::SsbcSettings& settings,
                                              std::span<const std::size_t> reflected, std::size_t target,
                                              core::Film& film);

void plan_screen_space(core::Plan& plan, const core::Requirements& requirements,
                       const screenspace::SsbcSettings& settings);

void register_screen_space_compensation(core::Registry& registry);

}  // namespace mote::integrators
