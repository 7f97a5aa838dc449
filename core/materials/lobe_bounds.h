// Upper bound of a lobe over all directions of light in a cone: Bsdf::eval_bound().
//
// Directions are local (z is the shading normal). Bounds hold with what rounding adds to them: `slack`.
#pragma once

#include "core/materials/microfacet.h"
#include "core/math/direction_cone.h"

namespace mote::core {

/// True if any direction of the cone is above the surface.
inline bool reaches_up(const DirectionCone& cone) {
    return cone.axis.z > 0.0f || cone.angle >= 0.5f * pi || -cone.axis.z < std::sin(cone.angle) + 1e-6f;
}

/// Facets that reflect light of a cone to wo: D / (4 A(wo) A(wi)) of Walter 2007, Eq. 20.
class LobeBound {
  public:
    /// Preconditions: wo.z > 0, reaches_up(wi).
    LobeBound(const Microfacet& facets, const Vec3& wo, const DirectionCone& wi);

    /// At least D(m) / (4 A(wo) A(wi)) for any wi of the cone [1/sr].
    float facets() const { return facets_; }
    /// At most the cosine between wo and any of the half vectors.
    float min_cosine() const { return min_cosine_; }

  private:
    float facets_, min_cosine_;
};

/// At least the reflectance of a dielectric of index eta at any cosine from `min_cosine` to 1. The
/// perpendicular part grows with the angle; the parallel one falls up to Brewster's angle and grows behind
/// it.
float dielectric_bound(float min_cosine, float eta);

}  // namespace mote::core
