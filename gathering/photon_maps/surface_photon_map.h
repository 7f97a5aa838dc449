// The photons on surfaces, and the radiance estimate from the nearest of them (Jensen 2001, Ch. 7).
#pragma once

#include <cmath>
#include <span>

#include "core/math/kd_tree.h"
#include "gathering/photon_maps/photon.h"

namespace mote::gathering {

/// Number of photons of an estimate, and the fraction of their radius that it uses (progressive_radius.h).
struct DensityEstimate {
    std::size_t neighbours = 50;   ///< k
    float radius_fraction = 1.0f;  ///< of the distance of the k-th, in (0, 1]
};

/// True if a photon on a surface with one geometric normal counts where a receiver has the other: they are
/// turned away by at most 60 degrees, or by that from the other side.
inline bool photon_counts(const core::Vec3& photon_normal, const core::Vec3& normal) {
    constexpr float min_normal_cosine = 0.5f;
    return std::fabs(glm::dot(photon_normal, normal)) >= min_normal_cosine;
}

/// For estimates whose sum alone is wanted.
struct IgnoreTerms {
    void operator()(std::uint32_t /*photon*/, const core::Rgb& /*light*/) const {}  ///< nothing
};

/// Photons on surfaces, ordered for estimates.
class SurfacePhotonMap {
  public:
    SurfacePhotonMap() = default;
    /// Sorts them into a k-d tree.
    explicit SurfacePhotonMap(std::vector<Photon> photons);

    /// Reflected radiance at `receiver` towards its wo, from photons of depth up to `max_depth`:
    ///   sum over p of f*(wo, w_p) Phi_p / (pi r^2)   (Engelhardt 2013, Eq. 4.5)
    /// r is `radius_fraction` times the distance of the k-th nearest photon, which itself is left out: with k
    /// - 1 in the numerator the estimate of an even density is unbiased. Photons on the receiver's other
    /// side, and those on surfaces turned more than 60 degrees away, do not count. Zero in a map of fewer
    /// than two photons. Calls visit(index, term) with each term of the sum.
    template <typename Visit = IgnoreTerms>
    core::Rgb radiance(const core::ScatteringVertex& receiver, const DensityEstimate& estimate, int max_depth,
                       std::vector<core::KdTree::Neighbour>& scratch, const Visit& visit = {}) const {
        const float r2 = find_photons(receiver, estimate, scratch);
        if (!(r2 > 0.0f)) return core::Rgb(0.0f);
        const float kappa = core::inv_pi / r2;  // of Engelhardt 2013, Eq. 4.5
        core::Rgb sum(0.0f);
        for (const core::KdTree::Neighbour& n : scratch) {
            if (!(n.distance_squared < r2)) continue;
            const core::Rgb light = reflected(photons_[n.index], receiver, max_depth);
            sum += light;
            visit(n.index, light * kappa);
        }
        return sum * kappa;
    }

    std::span<const Photon> photons() const { return photons_; }  ///< by index
    std::size_t size() const { return photons_.size(); }          ///< how many photons
    /// [B]
    std::size_t memory_bytes() const { return photons_.capacity() * sizeof(Photon) + tree_.memory_bytes(); }

  private:
    /// r^2, and at least the photons within it; 0: there are too few.
    float find_photons(const core::ScatteringVertex& receiver, const DensityEstimate& estimate,
                       std::vector<core::KdTree::Neighbour>& found) const;
    static core::Rgb reflected(const Photon& photon, const core::ScatteringVertex& receiver, int max_depth);

    core::KdTree tree_;
    std::vector<Photon> photons_;  ///< in the tree's order
};

}  // namespace mote::gathering
