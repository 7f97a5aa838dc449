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
        density[k] =
            weight[k] * normalization[k] * exp_of_negative(-0.5f * kappa[k] * (dx * dx + dy * dy + dz * dz));
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
    // product() with each lobe; f is copied: the compiler has to assume that it lies in the arrays.
    const Vec3 mean = f.mean;
    const float concentration = f.kappa, factor = vmf_normalization(f.kappa);
    MOTE_INDEPENDENT_LANES
    for (int k = 0; k < capacity; ++k) {
        const float dx = x[k] - mean.x, dy = y[k] - mean.y, dz = z[k] - mean.z;
        const float sx = kappa[k] * x[k] + concentration * mean.x,
                    sy = kappa[k] * y[k] + concentration * mean.y,
                    sz = kappa[k] * z[k] + concentration * mean.z;
        const float length = std::sqrt(sx * sx + sy * sy + sz * sz), scale = 1.0f / (length + 1e-30f);
        const float exponent = -kappa[k] * concentration * (dx * dx + dy * dy + dz * dz) /
                               (length + kappa[k] + concentration + 1e-30f);
        const float c = vmf_normalization(length);
        x[k] = sx * scale, y[k] = sy * scale, z[k] = sz * scale;
        weight[k] *= factor * normalization[k] / c * exp_of_negative(exponent);
        kappa[k] = length, normalization[k] = c;
    }
    const float total = sum_of(weight);
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
