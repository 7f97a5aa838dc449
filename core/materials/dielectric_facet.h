// The facet of a rough dielectric boundary that takes light from one direction to another (Walter 2007).
//
// With n_o, n_i the indices on the sides of wo and wi, and h = n_o wo + n_i wi, the refracting facet has the
// normal m = +-h/|h|, and the Jacobian of Walter's Eq. 17 is n_i^2 |wi.m| / |h|^2. Computing |h| in double
// precision avoids the cancellation in (n_o wo.m + n_i wi.m)^2 when the indices are close.
#pragma once

#include "core/materials/fresnel.h"
#include "core/materials/microfacet.h"

namespace mote::core {

struct DielectricFacet {
    float density = 0.0f;  ///< D(m); 0 when there is no such facet
    float cos_o = 0.0f;    ///< dot(wo, m), m on wo's side
    float reflectance = 0.0f;
    float jacobian = 0.0f;  ///< solid angle of m over that of wi, refraction only
    float eta = 1.0f;       ///< wi's side over wo's side
    Vec3 normal{0, 0, 1};   ///< on the surface normal's side
    bool transmitted = false;
};

/// `eta` is the index below the surface over that above. For all directions; flat ones have no facet.
inline DielectricFacet dielectric_facet(const Microfacet& facets, float eta, const Vec3& wo, const Vec3& wi) {
    DielectricFacet f;
    if (wo.z == 0.0f || wi.z == 0.0f) return f;
    f.transmitted = (wo.z > 0.0f) != (wi.z > 0.0f);
    const double across = wo.z > 0.0f ? double(eta) : 1.0 / double(eta);
    const double along = f.transmitted ? across : 1.0;
    f.eta = float(along);
    const Vec3d h = Vec3d(wo) + along * Vec3d(wi);
    const double length = glm::length(h);
    if (!(length > 0.0)) return f;
    Vec3d m = h / length;
    if ((m.z > 0.0) != (wo.z > 0.0f)) m = -m;
    const double cos_o = glm::dot(Vec3d(wo), m), cos_i = glm::dot(Vec3d(wi), m);
    // Both directions must see the facet from the side on which they see the surface.
    if (!(cos_o > 0.0) || !(f.transmitted ? cos_i < 0.0 : cos_i > 0.0)) return f;
    f.cos_o = float(cos_o);
    f.reflectance = float(fresnel_dielectric(std::fmin(cos_o, 1.0), across).reflectance);
    f.jacobian = float(along * along * -cos_i / (length * length));
    f.normal = wo.z > 0.0f ? Vec3(m) : Vec3(-m);
    f.density = facets.density(f.normal);
    return f;
}

}  // namespace mote::core
