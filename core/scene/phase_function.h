// The interface of scattering at a point of a medium.
//
// Both directions point away from the point: wo to the viewer, wi to the light. The phase function is
// normalised to one over the sphere [1/sr]; its cosine is dot(wo, wi), so forward scattering is a cosine of
// -1.
#pragma once

#include <optional>

#include "core/math/vec.h"
#include "core/objects/object.h"

namespace mote::core {

/// A direction sampled for a viewer.
struct PhaseSample {
    Vec3 wi;                ///< unit, away from the point
    Rgb weight;             ///< value / pdf
    float pdf_solid_angle;  ///< [1/sr]
};

/// Scattering of a medium at a point.
class PhaseFunction : public Object {
  public:
    /// Its value [1/sr].
    virtual Rgb eval(const Vec3& wo, const Vec3& wi) const = 0;
    /// Density of sample() choosing wi given wo. The reverse density is this with the directions exchanged.
    virtual float pdf_solid_angle(const Vec3& wo, const Vec3& wi) const = 0;
    /// Samples wi for wo from a point of the unit square.
    virtual PhaseSample sample(const Vec3& wo, const Vec2& u) const = 0;
    virtual bool isotropic() const = 0;
    /// Mean cosine of the scattering angle (0 for isotropic, > 0 forward).
    virtual float mean_cosine() const = 0;
    /// The g of Henyey & Greenstein's function where it is that one (0 for isotropic), which has closed
    /// forms; nothing where it is another.
    virtual std::optional<float> henyey_greenstein() const { return std::nullopt; }
};

}  // namespace mote::core
