// Fresnel reflectance of smooth interfaces: between dielectrics, and at a conductor (RGB index eta + i k).
//
// Unpolarised light. Cosines are on the side of incidence and lie in [0, 1]; `eta` is the index of the far
// side over that of the near side.
#pragma once

#include "core/math/vec.h"

namespace mote::core {

template <typename T>
struct FresnelResult {
    T reflectance;  ///< fraction of the power that is reflected, in [0, 1]
    T cos_t;        ///< cosine of the refracted direction; 0 at total internal reflection
};

/// Born & Wolf 1999, Sec. 1.5.2. Index ratio 1 reflects nothing, at grazing incidence as well.
template <typename T>
FresnelResult<T> fresnel_dielectric(T cos_i, T eta) {
    if (eta == T(1)) return {T(0), cos_i};
    // cos_t^2 = 1 - sin_i^2 / eta^2, written without the cancellation near grazing angles and eta = 1.
    const T cos2_t = ((eta - T(1)) * (eta + T(1)) + cos_i * cos_i) / (eta * eta);
    if (!(cos2_t > T(0))) return {T(1), T(0)};
    const T cos_t = std::sqrt(cos2_t);
    const T perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const T parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const T reflectance = T(0.5) * (perpendicular * perpendicular + parallel * parallel);
    return {reflectance < T(1) ? reflectance : T(1), cos_t};
}

/// Born & Wolf 1999, Sec. 14.4.1 (exact, no approximation for large k). eta = 0 with k > 0 reflects exactly
/// everything.
float fresnel_conductor(float cos_i, float eta, float k);
inline Rgb fresnel_conductor(float cos_i, const Rgb& eta, const Rgb& k) {
    return {fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
            fresnel_conductor(cos_i, eta.z, k.z)};
}

/// Reflectance of the interface under uniform illumination from the near side: the integral of
/// F(cos) 2 cos over cos in [0, 1], to about 1e-8.
double fresnel_diffuse_reflectance(double eta);

/// The direction refracted about the unit normal m, from `w` (m on w's side, dot(w, m) = cos_i > 0) into the
/// medium of relative index eta. `cos_t` comes from fresnel_dielectric and must be positive.
inline Vec3 refract(const Vec3& w, const Vec3& m, float cos_i, float cos_t, float eta) {
    const float inverse = 1.0f / eta;
    return m * (cos_i * inverse - cos_t) - w * inverse;
}

}  // namespace mote::core
