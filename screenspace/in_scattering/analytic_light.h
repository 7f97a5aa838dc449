// Lights and media whose in-scattering is integrated instead of marched: the intensity is constant, or falls
// off smoothly over the rim of a cone, and the medium is homogeneous with Henyey-Greenstein scattering.
//
// Left to marching: textured lights, whose intensity has any shape; cones of 90 degrees or more, which are
// not convex; and cones whose rim is most of them, because close to the axis the angle to it is no smooth
// function along a ray.
#pragma once

#include <optional>

#include "core/scene/lit_scene.h"
#include "lights/emitters/light_cone.h"
#include "screenspace/in_scattering/airlight.h"

namespace mote::screenspace {

/// A medium with a closed form.
struct AnalyticMedium {
    const core::Medium* medium;
    core::Rgb sigma_t, sigma_s;  ///< [1/m]
    float g;                     ///< mean cosine; 0: isotropic

    /// Nothing for media that are marched.
    static std::optional<AnalyticMedium> of(const core::Medium& medium);
    core::Rgb transmittance(double length) const;
};

class AnalyticLight {
  public:
    /// Nothing for lights that are marched. The light must have a position. Keeps a reference to it.
    static std::optional<AnalyticLight> of(const core::Emitter& light);

    /// Light scattered between t0 and t1 to the ray's point at t0; nothing may be in the way. The piece must
    /// lie in the light's cone.
    core::Rgb in_scattered(const core::Ray& ray, double t0, double t1, const AnalyticMedium& medium) const;

  private:
    AnalyticLight(const core::Emitter& light, const core::Vec3& position)
        : light_(light), position_(position) {}
    core::Rgb piece(const core::Ray& ray, const PassingRay& passing, double t0, double t1,
                    const AnalyticMedium& medium, bool rim) const;

    const core::Emitter& light_;
    core::Vec3 position_;
    core::Rgb intensity_{0.0f};  ///< where it is full [W/sr]
    bool has_rim_ = false;
    lights::LightCone beam_{};  ///< where it is full, if there is a rim
};

}  // namespace mote::screenspace
