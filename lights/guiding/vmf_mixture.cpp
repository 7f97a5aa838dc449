#include "lights/guiding/vmf_mixture.h"

#include <algorithm>

#include "core/math/vectorize.h"

namespace mote::lights {

using core::Vec2, core::Vec3;

namespace {

/// The sum over lobes, in a fixed order.
float sum_of(const float (&v)[VmfMixture::capacity]) {
    return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

}  // namespace

void VmfMixture::set(int k, const VmfLobe& l, float w) {
    x[k] = l.mean.x, y[k] = l.mean.y, z[k] = l.mean.z;
    kappa[k] = l.kappa, normalization[k] = vmf_normalization(l.kappa), weight[k] = w;
    empty = false;
}

float VmfMixture::pdf_solid_angle(const Vec3& w) const {
    float density[capacity];
    MOTE_INDEPENDENT_LANES
    for (int k = 0; k < capacity; ++k) {
        const float dx = x[k] - w.x, dy = y[k] - w.y, dz = z[k] - w.z;
        density[k] = weight[k] * normalization[k] *
                     exp_of_negative(-0.5f * kappa[k] * (dx * dx + dy * dy + dz * dz));
    }
    return sum_of(density);
}

Vec3 VmfMixture::sample(float u_lobe, const Vec2& u) const {
    int k = 0;
    for (; k + 1 < capacity && u_lobe >= weight[k]; ++k) u_lobe -= weight[k];
    while (k > 0 && !(weight[k] > 0.0f)) --k;  // rounding led past the last lobe
    return lobe(k).sample(u);
}

void VmfMixture::multiply(const VmfLobe& f) {
    float total = 0.0f;
    const float factor = vmf_normalization(f.kappa);
    MOTE_INDEPENDENT_LANES
    for (int k = 0; k < capacity; ++k) {  // product() of each lobe
        const float dx = x[k] - f.mean.x, dy = y[k] - f.mean.y, dz = z[k] - f.mean.z;
        const float kappas = kappa[k] + f.kappa, both = kappa[k] * f.kappa * (dx * dx + dy * dy + dz * dz);
        const float sx = kappa[k] * x[k] + f.kappa * f.mean.x, sy = kappa[k] * y[k] + f.kappa * f.mean.y,
                    sz = kappa[k] * z[k] + f.kappa * f.mean.z;
        const float length = std::sqrt(sx * sx + sy * sy + sz * sz), c = vmf_normalization(length);
        const float integral = factor * normalization[k] / c * exp_of_negative(-both / (length + kappas + 1e-30f));
        const float scale = length > 0.0f ? 1.0f / length : 0.0f;
        x[k] = length > 0.0f ? sx * scale : x[k], y[k] = length > 0.0f ? sy * scale : y[k],
        z[k] = length > 0.0f ? sz * scale : z[k];
        kappa[k] = length, normalization[k] = c, weight[k] *= integral;
    }
    total = sum_of(weight);
    empty = !(total > 0.0f) || !std::isfinite(total);
    if (empty) return;
    for (float& w : weight) w /= total;
}

VmfMixture even_mixture() {
    VmfMixture m;
    const float golden = core::pi * (3.0f - std::sqrt(5.0f));
    for (int k = 0; k < VmfMixture::capacity; ++k) {  // a spiral of equal areas
        const float cosine = 1.0f - 2.0f * (float(k) + 0.5f) / float(VmfMixture::capacity);
        const float sine = core::safe_sqrt(1.0f - cosine * cosine), phi = golden * float(k);
        m.set(k, {{sine * std::cos(phi), sine * std::sin(phi), cosine}, 4.0f},
              1.0f / float(VmfMixture::capacity));
    }
    return m;
}

}  // namespace mote::lights
