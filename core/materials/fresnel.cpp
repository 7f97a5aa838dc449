// The parts of the Fresnel equations that are too long to be inline.
#include "core/materials/fresnel.h"

#include <algorithm>

namespace mote::core {

float fresnel_conductor(float cos_i, float eta, float k) {
    const float cos2 = cos_i * cos_i, sin2 = std::max(0.0f, 1.0f - cos2);
    // a + i b = sqrt((eta + i k)^2 - sin^2): take the larger of a and b as a root and the other from
    // a b = eta k, so that nothing cancels when one of them is small (a perfect mirror has a = 0 exactly).
    const float real = eta * eta - k * k - sin2;
    const float modulus = std::sqrt(real * real + 4.0f * eta * eta * k * k);
    const float larger = std::sqrt(0.5f * (modulus + std::fabs(real)));
    const float smaller = larger > 0.0f ? eta * k / larger : 0.0f;
    const float a = real >= 0.0f ? larger : smaller;

    // R_s = (s0 - s1) / (s0 + s1) and R_p = R_s (p0 - p1) / (p0 + p1); their mean needs one division.
    const float s0 = modulus + cos2, s1 = 2.0f * a * cos_i;
    const float p0 = modulus * cos2 + sin2 * sin2, p1 = s1 * sin2;
    const float denominator = (s0 + s1) * (p0 + p1);
    return denominator > 0.0f ? std::clamp((s0 - s1) * p0 / denominator, 0.0f, 1.0f) : 1.0f;
}

double fresnel_diffuse_reflectance(double eta) {
    // From the dense side, reciprocity of the transmitted light gives (1 - F_int) eta^2 = 1 - F_ext; it
    // avoids integrating over the kink at the critical angle.
    if (eta < 1.0) return 1.0 - (1.0 - fresnel_diffuse_reflectance(1.0 / eta)) * (eta * eta);
    constexpr int intervals = 512;  // Simpson
    double sum = 0.0;
    for (int i = 0; i <= intervals; ++i) {
        const double mu = double(i) / intervals;
        const double weight = i == 0 || i == intervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        sum += weight * 2.0 * mu * fresnel_dielectric(mu, eta).reflectance;
    }
    return sum / (3.0 * intervals);
}

}  // namespace mote::core
