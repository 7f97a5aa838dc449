// Screen-space bias compensation at the end of a render (Engelhardt 2013, Ch. 11), for the light that
// surfaces reflect; light first scattered in media may be compensated by another method in the passes: the
// combination that Sec. 10.6 names as future work.
#pragma once

#include "compensation/compensation_settings.h"
#include "core/film/film.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "screenspace/ssbc/ssbc.h"

namespace mote::integrators {

struct ScreenSpaceSettings {
    screenspace::SsbcSettings ssbc;  ///< but for the bound, which is that of the render
    int layers = 1;                  ///< of surfaces along a ray; 1: what the picture shows
    int vpl_share = 4;               ///< at each hidden point: one VPL of so many, in turn

    /// Auxiliary layers of the light that hidden sides reflect (hidden_light.h).
    std::vector<core::Layer> film_layers() const;
};

/// A nested <compensation type="screen_space"> of a scene file.
class ScreenSpaceCompensation : public core::Object {
  public:
    ScreenSpaceCompensation(const ScreenSpaceSettings& settings, compensation::CompensationSettings media)
        : settings_(settings), media_(media) {}
    const ScreenSpaceSettings& settings() const { return settings_; }
    /// Compensation of receivers in media alone.
    const compensation::CompensationSettings& media() const { return media_; }

  private:
    ScreenSpaceSettings settings_;
    compensation::CompensationSettings media_;
};

struct ScreenSpaceCost {
    std::uint64_t samples = 0;  ///< nodes of the hierarchy and pixels that were added up
    double seconds = 0.0;       ///< G-buffers and all steps
    double cpu_seconds = 0.0;   ///< the same, of all threads
};

/// Layers of the film that a compensation reads and writes.
struct ScreenSpaceLayers {
    std::span<const std::size_t> reflected;  ///< light that surfaces send to the eye, direct and indirect
    std::size_t target;                      ///< filled with what the bound took from it
    std::size_t hidden;                      ///< the first of hidden sides, where there are several layers
};

/// `bound` is b [1/m^2].
ScreenSpaceCost add_screen_space_compensation(const core::Scene& scene, const ScreenSpaceSettings& settings,
                                              float bound, const ScreenSpaceLayers& layers,
                                              core::CancelToken cancelled, core::Film& film);

void plan_screen_space(core::Plan& plan, const core::Requirements& requirements,
                       const ScreenSpaceSettings& settings);

void register_screen_space_compensation(core::Registry& registry);

}  // namespace mote::integrators
