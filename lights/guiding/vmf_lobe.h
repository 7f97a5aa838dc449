// The von Mises-Fisher distribution of directions: a lobe of mean direction mu and concentration kappa,
//   f(w) = c exp(kappa (mu.w - 1)),   c = kappa / (2 pi (1 - exp(-2 kappa))).
//
// The product of two lobes is a lobe times a constant, which makes mixtures of them the tool of path guiding
// (Vorba et al. 2014; Herholz et al. 2019). mu.w - 1 is computed as half the squared distance of unit
// vectors, so that nothing cancels at large kappa; kappa = 0 is the uniform sphere.
#pragma once

#include <bit>

#include "core/math/vec.h"

namespace mote::lights {

/// exp(x) for x <= 0, by the polynomial of Cephes (S. Moshier, expf.c). Without a branch or a call, as vector
/// code has them; below -87 it stays at 1e-38.
inline float exp_of_negative(float x) {
    x = x > -87.0f ? x : -87.0f;
    const auto n = std::int32_t(x * 1.44269504f - 0.5f);
    const float r = x - float(n) * 0.693359375f + float(n) * 2.12194440e-4f;
    const float p =
        r * (r * (r * (r * (r * 1.9875691500e-4f + 1.3981999507e-3f) + 8.3334519073e-3f) + 4.1665795894e-2f) +
             1.6666665459e-1f) +
        5.0000001201e-1f;
    return (p * r * r + r + 1.0f) * std::bit_cast<float>((n + 127) << 23);
}

/// c of a lobe. At small kappa by its series, where 1 - exp(-2 kappa) would cancel; without a branch.
inline float vmf_normalization(float kappa) {
    const float small = kappa < 0.05f ? 1.0f : 0.0f, large = kappa < 0.05f ? 0.05f : kappa;
    const float series = core::inv_four_pi * (1.0f + kappa * (1.0f + kappa * (1.0f / 3.0f)));
    const float closed = core::inv_two_pi * large / (1.0f - exp_of_negative(-2.0f * large));
    return small * series + (1.0f - small) * closed;
}

/// Largest concentration of a lobe: beyond it unit vectors in single precision do not resolve the lobe.
inline constexpr float max_kappa = 1e6f;

/// A lobe.
struct VmfLobe {
    core::Vec3 mean{0.0f, 0.0f, 1.0f};  ///< mu, unit
    float kappa = 0.0f;                 ///< concentration, from 0 to max_kappa

    /// f(w) [1/sr].
    float pdf_solid_angle(const core::Vec3& w) const;
    /// Samples a direction.
    core::Vec3 sample(const core::Vec2& u) const;
};

/// f_a f_b = integral * f of `lobe`.
struct VmfProduct {
    VmfLobe lobe;    ///< f
    float integral;  ///< over all directions [1/sr]
};
/// The product of two lobes.
VmfProduct product(const VmfLobe& a, const VmfLobe& b);

/// Mean cosine of a lobe: coth kappa - 1 / kappa.
double mean_cosine_of_kappa(double kappa);
/// The kappa of a mean cosine in [0, 1], at most max_kappa (Banerjee et al. 2005, Eq. 4.4).
float kappa_of_mean_cosine(double mean_cosine);

/// Approximates the clamped cosine around the normal n, without its integral.
VmfLobe cosine_lobe(const core::Vec3& n);
/// Approximates a phase function of this mean cosine; wo points away from the vertex.
VmfLobe phase_lobe(const core::Vec3& wo, float mean_cosine);

}  // namespace mote::lights
