#include "lights/guiding/vmf_lobe.h"

#include <algorithm>

#include "core/math/frame.h"

namespace mote::lights {

using core::Vec2, core::Vec3;

namespace {

/// 1 - a.b of unit vectors, without cancellation.
float one_minus_cosine(const Vec3& a, const Vec3& b) {
    const Vec3 d = a - b;
    return 0.5f * glm::dot(d, d);
}

}  // namespace

float VmfLobe::pdf_solid_angle(const Vec3& w) const {
    return vmf_normalization(kappa) * exp_of_negative(-kappa * one_minus_cosine(mean, w));
}

Vec3 VmfLobe::sample(const Vec2& u) const {
    // The inverse of the distribution of h = 1 - cos: h = -log(1 - u (1 - exp(-2 kappa))) / kappa (Jakob
    // 2012).
    const float h = kappa > 1e-4f ? -std::log1p(u.x * std::expm1(-2.0f * kappa)) / kappa : 2.0f * u.x;
    const float bounded = std::clamp(h, 0.0f, 2.0f);
    const float sine = core::safe_sqrt(bounded * (2.0f - bounded)), phi = 2.0f * core::pi * u.y;
    return glm::normalize(
        core::Frame(mean).to_world({sine * std::cos(phi), sine * std::sin(phi), 1.0f - bounded}));
}

VmfProduct product(const VmfLobe& a, const VmfLobe& b) {
    // kappa mu = kappa_a mu_a + kappa_b mu_b. The exponent kappa - kappa_a - kappa_b is written as a
    // quotient, in which nothing cancels.
    const Vec3 sum = a.kappa * a.mean + b.kappa * b.mean;
    const float kappa = glm::length(sum), kappas = a.kappa + b.kappa;
    const float exponent =
        kappas > 0.0f ? -2.0f * a.kappa * b.kappa * one_minus_cosine(a.mean, b.mean) / (kappa + kappas)
                      : 0.0f;
    const VmfLobe lobe{kappa > 0.0f ? sum / kappa : a.mean, kappa};
    return {lobe, vmf_normalization(a.kappa) * vmf_normalization(b.kappa) / vmf_normalization(kappa) *
                      exp_of_negative(exponent)};
}

double mean_cosine_of_kappa(double kappa) {
    return kappa > 1e-2 ? 1.0 / std::tanh(kappa) - 1.0 / kappa : kappa / 3.0;
}

float kappa_of_mean_cosine(double r) {
    if (!(r > 0.0)) return 0.0f;
    const double kappa = r < 1.0 ? r * (3.0 - r * r) / ((1.0 - r) * (1.0 + r)) : double(max_kappa);
    return float(std::min(kappa, double(max_kappa)));
}

VmfLobe cosine_lobe(const Vec3& n) {
    // The clamped cosine has the mean cosine 2/3.
    static const float kappa = kappa_of_mean_cosine(2.0 / 3.0);
    return {n, kappa};
}

VmfLobe phase_lobe(const Vec3& wo, float mean_cosine) {
    return {mean_cosine < 0.0f ? wo : -wo, kappa_of_mean_cosine(double(std::fabs(mean_cosine)))};
}

}  // namespace mote::lights
