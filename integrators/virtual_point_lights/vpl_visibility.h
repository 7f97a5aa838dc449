// Visibility between VPLs and receivers in `mote_vpl`: a nested <visibility> of a scene file.
#pragma once

#include "core/parameters/add_type.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "lights/imperfect_shadow_maps/imperfect_shadow_maps.h"
#include "lights/shadow_maps/volumetric_shadow_map.h"

namespace mote::integrators {

struct VisibilitySettings {
    bool shadow_maps = false;  ///< volumetric ones
    bool imperfect = false;    ///< maps of points; without either: traced
    int size = 64;             ///< texels along an edge of a VPL's map
    int light_size = 256;      ///< of the lights' own maps; 0: none, they are traced
    int maps = 4;              ///< kept at once
    lights::ShadowMapSettings map;
    lights::ImperfectMapSettings imperfect_map;
    core::SourceLocation where;

    /// Maps are used: they are enabled, and there are media.
    bool used_in(const core::Scene& scene) const { return shadow_maps && scene.has_media(); }
    /// Throws InputError with its place when a map of this scene would be larger than the limit.
    void check(const core::Scene& scene) const;
};

/// A nested <visibility> of a scene file.
using Visibility = core::SettingsObject<VisibilitySettings>;

/// traced, shadow_map, imperfect_shadow_map.
void register_visibility(core::Registry& registry);

/// `receivers`: of one pass, about.
void plan_visibility(core::Plan& plan, const core::Scene& scene, const VisibilitySettings& settings,
                     double receivers);

}  // namespace mote::integrators
