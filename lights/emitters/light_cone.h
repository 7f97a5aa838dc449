// The cone that a light shines into, for methods that look for its light along rays.
#pragma once

#include <optional>

#include "core/math/ray.h"

namespace mote::lights {

/// Apex, axis and half angle; the light is black outside.
struct LightCone {
    core::Vec3 apex, axis;  ///< axis: unit, away from the light
    double angle;           ///< [radians]
    double beam = 0.0;      ///< half angle within which the intensity is constant; from there to `angle` it
                            ///< varies smoothly; 0: nothing is known [radians]
};

/// A light with a cone. Emitters that are none shine everywhere.
class ConeLight {
  public:
    virtual ~ConeLight() = default;
    virtual LightCone cone() const = 0;
};

/// The part of [t0, t1] of a ray inside the cone, or nothing. t1 may be infinite. A cone of 90 degrees or
/// more is not convex and leaves the whole interval.
std::optional<std::pair<double, double>> inside_cone(const LightCone& cone, const core::Ray& ray, double t0,
                                                     double t1);

}  // namespace mote::lights
