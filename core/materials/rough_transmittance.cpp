// Quadrature over visible normals: points in the square that feeds the sampling routine.
#include "core/materials/rough_transmittance.h"

#include <algorithm>
#include <array>

#include "core/materials/fresnel.h"

namespace mote::core {
namespace {

struct Node {
    double x, weight;
};

/// Gauss-Legendre quadrature on [0, 1]: dense at both ends, where the steepest facets are. Abramowitz &
/// Stegun 1964, Eq. 25.4.29.
template <int n>
std::array<Node, n> gauss_legendre() {
    std::array<Node, n> nodes{};
    for (int i = 0; i < n; ++i) {
        double x = std::cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 6; ++step) {  // Newton's method on the Legendre polynomial P_n
            double p0 = 1.0, p1 = x;
            for (int k = 2; k <= n; ++k) {
                const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
                p0 = p1, p1 = p2;
            }
            slope = n * (x * p1 - p0) / (x * x - 1.0);
            x -= p1 / slope;
        }
        nodes[std::size_t(i)] = {0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope)};
    }
    return nodes;
}

/// The mean of f(wo, m, cos) over the visible normals m seen at angle acos(mu).
template <int n, typename F>
double mean_over_facets(const Microfacet& microfacet, float mu, F f) {
    static const std::array<Node, n> nodes = gauss_legendre<n>();
    const float clamped = std::clamp(mu, 1e-4f, 1.0f);
    const Vec3 wo(safe_sqrt(1.0f - sqr(clamped)), 0.0f, clamped);
    double sum = 0.0;
    for (const Node& u : nodes)
        for (const Node& v : nodes) {
            const Vec3 m = microfacet.sample_visible(wo, {float(u.x), float(v.x)});
            const float c = std::min(glm::dot(wo, m), 1.0f);
            if (c > 0.0f) sum += u.weight * v.weight * double(f(wo, m, c));
        }
    return sum;
}

/// Where light can be reflected totally, which makes an edge, with more points.
template <typename F>
double mean_over_facets(const Microfacet& microfacet, float eta, float mu, F f) {
    return eta < 1.0f ? mean_over_facets<64>(microfacet, mu, f) : mean_over_facets<32>(microfacet, mu, f);
}

}  // namespace

double rough_reflectance(const Microfacet& microfacet, float eta, float mu) {
    return mean_over_facets(microfacet, eta, mu, [&](const Vec3& wo, const Vec3& m, float c) {
        const Vec3 wi = 2.0f * c * m - wo;
        return wi.z > 0.0f ? fresnel_dielectric(c, eta).reflectance * microfacet.masking(wi) : 0.0f;
    });
}

double rough_transmittance(const Microfacet& microfacet, float eta, float mu) {
    return mean_over_facets(microfacet, eta, mu, [&](const Vec3& wo, const Vec3& m, float c) {
        const auto f = fresnel_dielectric(c, eta);
        if (!(f.cos_t > 0.0f)) return 0.0f;
        const Vec3 wi = refract(wo, m, c, f.cos_t, eta);
        return wi.z < 0.0f ? (1.0f - f.reflectance) * microfacet.masking(wi) : 0.0f;
    });
}

RoughTransmittance::RoughTransmittance(const Microfacet& microfacet, float eta, LostLight lost) {
    const double step = 1.0 / double(size - 1);
    for (std::size_t i = 0; i < size; ++i) {
        const auto mu = float(double(i) * step);
        table_[i] = float(lost == LostLight::absorbed ? rough_transmittance(microfacet, eta, mu)
                                                      : 1.0 - rough_reflectance(microfacet, eta, mu));
    }
    if (lost == LostLight::transmitted) lower_the_first(microfacet, eta);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < size; ++i) {
        const double x0 = double(i) * step, x1 = x0 + step, a = double(table_[i]), b = double(table_[i + 1]);
        sum += step / 3.0 * (a * (2.0 * x0 + x1) + b * (x0 + 2.0 * x1));  // 2 x times a linear function
    }
    mean_ = float(sum);
}

/// Where roughness is finer than the table, 1 - R turns up again within the first interval (facets mask each
/// other below mu = alpha). The interpolant stays below it, so that no light is made.
void RoughTransmittance::lower_the_first(const Microfacet& microfacet, float eta) {
    const double step = 1.0 / double(size - 1);
    for (double mu = 1e-4; mu < step; mu *= 2.0) {
        const double t = mu / step, here = 1.0 - rough_reflectance(microfacet, eta, float(mu));
        const double support = (here - t * double(table_[1])) / (1.0 - t);
        table_[0] = float(std::clamp(support, 0.0, double(table_[0])));
    }
}

float rough_internal_reflectance(const Microfacet& microfacet, float eta) {
    constexpr int n = 64;
    double sum = 0.0;
    for (int i = 1; i < n; ++i) {
        const double mu = double(i) / (n - 1);
        sum += 2.0 * mu * rough_reflectance(microfacet, 1.0f / eta, float(mu));
    }
    return float(sum / n);
}

}  // namespace mote::core
