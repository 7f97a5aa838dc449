// Weighted stepwise expectation maximisation of a mixture of von Mises-Fisher lobes (Vorba et al. 2014), with
// priors that keep lobes of few samples wide (Ruppert et al. 2020).
//
// Sums over samples i with weights w_i and responsibilities g_ik of lobe k,
//   W_k = sum g w,   R_k = sum g w omega,   Q_k = sum g w^2,
// add up over batches. A lobe has n_k = W_k^2 / Q_k effective samples (Kish 1965); a lone firefly is one,
// however bright it is, and brings at most 1/20 of the light. With them
//   weight_k     = (n W_k / W + a) / (n + K a),
//   mean cosine  = n_k / (n_k + b) |R_k| / W_k,
// are the maximum a posteriori. Each lobe also has the weighted mean of its samples' inverse distances, from
// which the mixture of a leaf is seen by parallax from any of its points.
#pragma once

#include <span>

#include "lights/guiding/vmf_mixture.h"

namespace mote::lights {

/// Incident radiance found in one direction.
struct GuidingSample {
    core::Vec3 position;     ///< where it arrives [m]
    core::Vec3 direction;    ///< unit, to where it comes from
    float weight;            ///< radiance over the density of the direction; finite, not negative
    float inverse_distance;  ///< of where it comes from [1/m]; 0: from outside of the scene
};

/// A mixture that learns.
class MixtureFit {
  public:
    using Sample = GuidingSample;             ///< as SpatialTree needs it
    static constexpr double inherited = 0.5;  ///< by each half of a leaf (SpatialTree)

    /// An even mixture, as seen from `pivot`.
    explicit MixtureFit(const core::Vec3& pivot) : pivot_(pivot) { mixture_.empty = true; }

    /// A batch of samples, in their order. Weights of zero count as samples without light.
    void add(std::span<const GuidingSample> samples);
    /// All that was learned so far counts this much; the mixture stays.
    void scale(double factor);
    /// Copy as seen from another point.
    MixtureFit moved_to(const core::Vec3& pivot) const;

    /// The mixture at a point, by parallax. Empty before light was found.
    VmfMixture at(const core::Vec3& position) const;

    double samples() const { return samples_; }                    ///< those without light too
    double light() const;                                          ///< sum of all weights
    const VmfMixture& mixture() const { return mixture_; }         ///< as seen from pivot()
    const core::Vec3& pivot() const { return pivot_; }             ///< [m]
    float inverse_distance(int k) const { return distances_[k]; }  ///< of lobe k [1/m]

  private:
    struct Sums {
        double weight = 0.0, squares = 0.0, inverse_distance = 0.0;
        core::Vec3d direction{0.0};
    };
    void expect(std::span<const GuidingSample> samples, double bound,
                Sums (&sums)[VmfMixture::capacity]) const;
    void maximise(const Sums (&sums)[VmfMixture::capacity]);

    core::Vec3 pivot_;
    VmfMixture mixture_ = even_mixture();
    float distances_[VmfMixture::capacity] = {};
    Sums sums_[VmfMixture::capacity];
    double samples_ = 0.0;
};

}  // namespace mote::lights
