// A mixture of von Mises-Fisher lobes, in structures of arrays, so that loops over lobes become vector
// instructions.
#pragma once

#include "lights/guiding/vmf_lobe.h"

namespace mote::lights {

/// Eight lobes, or none.
struct alignas(32) VmfMixture {
    static constexpr int capacity = 8;  ///< lobes

    float x[capacity], y[capacity], z[capacity];      ///< mean directions of the lobes
    float kappa[capacity];                            ///< concentrations
    float normalization[capacity], weight[capacity];  ///< c of each; the weights of all add up to 1
    float probability = 0.5f;  ///< of a direction of the mixture, not of the vertex (scattering_guide.h)
    bool empty = true;         ///< without lobes; nothing else is set

    /// Lobe k.
    VmfLobe lobe(int k) const { return {{x[k], y[k], z[k]}, kappa[k]}; }
    /// Sets lobe k, and the weight of it.
    void set(int k, const VmfLobe& l, float w);

    /// Density [1/sr]; not of an empty mixture.
    float pdf_solid_angle(const core::Vec3& w) const;
    /// Samples a lobe by u_lobe, and a direction; not of an empty mixture.
    core::Vec3 sample(float u_lobe, const core::Vec2& u) const;
    /// Becomes its product with a lobe, normalised. Empty where their product vanishes.
    void multiply(const VmfLobe& factor);
};

/// Lobes spread evenly over the sphere, all of equal weight: where fits begin.
VmfMixture even_mixture();

}  // namespace mote::lights
