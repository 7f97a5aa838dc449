// Sampling of visible normals. The direction is stretched so that the surface has roughness 1, a normal is
// sampled there, and its slopes are stretched back (Heitz & d'Eon 2014).
#include "core/materials/microfacet.h"

#include <algorithm>

namespace mote::core {
namespace {

/// Inverse of erf on (-1, 1): Giles 2010, the polynomials for single precision (relative error about 1e-7).
double erf_inverse(double x) {
    double w = -std::log((1.0 - x) * (1.0 + x)), p;
    if (w < 5.0) {
        w -= 2.5;
        p = 2.81022636e-08;
        for (const double c : {3.43273939e-07, -3.5233877e-06, -4.39150654e-06, 0.00021858087, -0.00125372503,
                               -0.00417768164, 0.246640727, 1.50140941})
            p = c + p * w;
    } else {
        w = std::sqrt(w) - 3.0;
        p = -0.000200214257;
        for (const double c : {0.000100950558, 0.00134934322, -0.00367342844, 0.00573950773, -0.0076224613,
                               0.00943887047, 1.00167406, 2.83297682})
            p = c + p * w;
    }
    return p * x;
}

constexpr double sqrt_pi = 1.7724538509055160273;

/// Samples the slope x along the viewing azimuth with density proportional to (c - x) exp(-x^2) for x < c,
/// where c > 0 is the cotangent of the viewing angle. With b = erf(x) the distribution function is
/// proportional to  c sqrt(pi) (1 + b) + exp(-x^2),  which Newton's method inverts inside a bracket.
double sample_beckmann_slope(double c, double u) {
    const auto distribution = [c](double b, double x) { return c * sqrt_pi * (1.0 + b) + std::exp(-x * x); };
    const double end = std::min(c, 5.0), erf_end = std::erf(end);  // erf(5) = 1 - 1.5e-12
    const double target = u * distribution(erf_end, end);
    double low = -1.0 + 1e-9, high = std::min(erf_end, 1.0 - 1e-9);
    // A first guess between the limits of normal (b linear in u) and grazing incidence (near a square root).
    const double t = c / (c + 4.0);
    double b = high - (1.0 + high) * (t * (1.0 - u) + (1.0 - t) * std::sqrt(1.0 - u));
    b = std::clamp(b, low, high);
    double x = erf_inverse(b);
    for (int i = 0; i < 40; ++i) {
        const double error = distribution(b, x) - target;
        if (std::fabs(error) < 1e-7 * (target + 1e-3)) break;
        (error > 0.0 ? high : low) = b;
        const double slope = sqrt_pi * (c - x);  // d/db, for db = 2/sqrt(pi) exp(-x^2) dx
        const double next = slope > 0.0 ? b - error / slope : low;
        b = next > low && next < high ? next : 0.5 * (low + high);
        x = erf_inverse(b);
    }
    return x;
}

Vec3 sample_beckmann(const Vec3& w, const Vec2& u) {
    const double r = std::sqrt(double(w.x) * w.x + double(w.y) * w.y);
    const double cos_phi = r > 0.0 ? w.x / r : 1.0, sin_phi = r > 0.0 ? w.y / r : 0.0;
    const double c = std::min(double(w.z) / std::max(r, 1e-30), 1e8);
    const double inside = 0x1p-25;  // half a step of the random numbers: keeps the tails finite
    const double x = sample_beckmann_slope(c, double(u.x) + inside);
    const double y = erf_inverse(2.0 * (double(u.y) + inside) - 1.0);
    // A facet of slopes (x, y) has the normal (-x, -y, 1); rotate from the viewing azimuth.
    return {float(-(cos_phi * x - sin_phi * y)), float(-(sin_phi * x + cos_phi * y)), 1.0f};
}

/// The half vectors of w with points of a spherical cap are the visible normals (Dupuy & Benyoub 2023).
Vec3 sample_ggx(const Vec3& w, const Vec2& u) {
    const float phi = 2.0f * pi * u.x;
    const float z = (1.0f - u.y) * (1.0f + w.z) - w.z;
    const float r = safe_sqrt(1.0f - z * z);
    return {r * std::cos(phi) + w.x, r * std::sin(phi) + w.y, z + w.z};
}

}  // namespace

Vec3 Microfacet::sample_visible(const Vec3& wo, const Vec2& u) const {
    const Vec3 stretched = glm::normalize(Vec3(alpha_u_ * wo.x, alpha_v_ * wo.y, wo.z));
    const Vec3 m = kind_ == MicrofacetKind::ggx ? sample_ggx(stretched, u) : sample_beckmann(stretched, u);
    return Vec3(glm::normalize(Vec3d(alpha_u_ * m.x, alpha_v_ * m.y, std::fmax(m.z, 1e-9f))));
}

}  // namespace mote::core
