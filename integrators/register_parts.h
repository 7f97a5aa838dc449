// Registrations of the integrators of this folder, one function a file, and plan entries that they share.
#pragma once

#include "core/objects/registry.h"
#include "core/render/integrator.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "integrators/eye_path/eye_path_limits.h"

namespace mote::integrators {

enum class ScatteringLights : std::uint8_t;  // single_scattering/single_scattering_estimator.h

void register_screen_space_compensation(core::Registry& registry);
void register_mote_layers(core::Registry& registry);
void register_path(core::Registry& registry);
void register_volpath(core::Registry& registry);
void register_mote_bdpt(core::Registry& registry);
void register_mote_upbp(core::Registry& registry);
void register_mote_vpl(core::Registry& registry);
void register_mote_vpl_ray_bundles(core::Registry& registry);
void register_mote_micro_rendering(core::Registry& registry);
void register_mote_photon_map(core::Registry& registry);
void register_mote_ray_bundles(core::Registry& registry);
void register_mote_vsl(core::Registry& registry);
void register_mote_ray_lights(core::Registry& registry);
void register_mote_single_scattering(core::Registry& registry);
void register_mote_epipolar(core::Registry& registry);

// Methods that a scene's requirements choose (layers/layer_methods.h), with the settings of a scene file that
// names nothing but these limits.
std::shared_ptr<const core::Integrator> make_path(const EyePathLimits& limits);
std::shared_ptr<const core::Integrator> make_volpath(const EyePathLimits& limits);
/// Virtual point lights by the ten thousand, resampled for pixels that do not lie side by side, as an image
/// filter wants them. What their bound takes is missing.
std::shared_ptr<const core::Integrator> make_sampled_vpls(const EyePathLimits& limits);
/// Light of these lights, scattered once in media, along epipolar lines.
std::shared_ptr<const core::Integrator> make_epipolar(const EyePathLimits& limits, ScatteringLights which,
                                                      int lines, int samples);
/// Light of lights without a position that scatters once in media, and all on surfaces.
std::shared_ptr<const core::Integrator> make_single_scattering(const EyePathLimits& limits);

/// Light that passes delta surfaces last, for integrators that can only hit lights.
void plan_caustics(core::Plan& plan, const core::Scene& scene, const core::Requirements& requirements);

/// Choice among several lights for direct light (core/scene/light_tree.h); nothing where there is one.
void plan_choice_of_lights(core::Plan& plan, const core::Scene& scene);

/// Several samples of lights at one vertex (eye_path/light_samples.h); nothing where there is one.
void plan_samples_of_lights(core::Plan& plan, const core::Scene& scene);

/// Sampling of the emission of media.
void plan_medium_lights(core::Plan& plan, const core::Requirements& requirements);

/// Methods that run for the media of a scene, with reasons.
void plan_media(core::Plan& plan, const core::Requirements& requirements);

}  // namespace mote::integrators
