// Quadrature over visible normals: a regular grid of points in the square that feeds the sampling routine.
#include "core/materials/rough_transmittance.h"

#include <algorithm>

#include "core/materials/fresnel.h"

namespace mote::core {

double rough_reflectance(const Microfacet& microfacet, float eta, float mu) {
    const float clamped = std::clamp(mu, 1e-4f, 1.0f);
    const Vec3 wo(safe_sqrt(1.0f - sqr(clamped)), 0.0f, clamped);
    constexpr int n = 32;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const Vec3 m = microfacet.sample_visible(wo, {(float(i) + 0.5f) / n, (float(j) + 0.5f) / n});
            const float c = std::min(glm::dot(wo, m), 1.0f);
            if (!(c > 0.0f)) continue;
            const Vec3 wi = 2.0f * c * m - wo;
            if (wi.z > 0.0f) sum += double(fresnel_dielectric(c, eta).reflectance * microfacet.masking(wi));
        }
    }
    return sum / (n * n);
}

RoughTransmittance::RoughTransmittance(const Microfacet& microfacet, float eta) {
    const double step = 1.0 / double(size - 1);
    for (std::size_t i = 0; i < size; ++i)
        table_[i] = float(1.0 - rough_reflectance(microfacet, eta, float(double(i) * step)));
    // Where roughness is finer than the table, 1 - R turns up again within the first interval (facets mask
    // each other below mu = alpha). The interpolant stays below it, so that no light is made.
    for (double mu = 1e-4; mu < step; mu *= 2.0) {
        const double t = mu / step, here = 1.0 - rough_reflectance(microfacet, eta, float(mu));
        const double support = (here - t * double(table_[1])) / (1.0 - t);
        table_[0] = float(std::clamp(support, 0.0, double(table_[0])));
    }
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < size; ++i) {
        const double x0 = double(i) * step, x1 = x0 + step, a = double(table_[i]), b = double(table_[i + 1]);
        sum += step / 3.0 * (a * (2.0 * x0 + x1) + b * (x0 + 2.0 * x1));  // 2 x times a linear function
    }
    mean_ = float(sum);
}

float rough_internal_reflectance(const Microfacet& microfacet, float eta) {
    constexpr int n = 64;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        const double mu = (i + 0.5) / n;
        sum += 2.0 * mu * rough_reflectance(microfacet, 1.0f / eta, float(mu));
    }
    return float(sum / n);
}

}  // namespace mote::core
