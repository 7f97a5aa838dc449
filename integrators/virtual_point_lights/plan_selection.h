// Advice of a plan on the selection of virtual point lights: what suits the scene, by the measured tables.
#pragma once

#include "core/render/plan.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"

namespace mote::integrators {

/// Sizes of the gather of a pass.
struct GatherSize {
    double vpls = 0.0;        ///< about
    double receivers = 0.0;   ///< of a picture, about
    int points = 1;           ///< a pixel, on surfaces and in media
    bool filtered = false;    ///< the picture, in image space
    double depth = 0.0;       ///< optical, across media that scatter; 0: there are none
    bool homogeneous = true;  ///< all of those
};

/// The mean optical depth of lines that cross media that scatter, side by side and along each axis.
double depth_of_media(const core::Scene& scene);

/// The choice by docs/methods/many_lights.md: brute force costs lights times receivers; the others differ in
/// what they use before they trace a ray, and that is worth most where most lights are hidden.
void plan_selection_advice(core::Plan& plan, const GatherSize& size);

/// For receivers that take all VPLs: a warning where a pass takes more than half a minute of one processor.
void warn_of_long_passes(core::Plan& plan, const GatherSize& size);

}  // namespace mote::integrators
