// The photons in media as discs that face the eye ray: the beam radiance estimate (Jarosz et al. 2008).
//
// Instead of looking for photons around many points of a ray, every photon has a radius of its own, from the
// density of photons around it, and the ray meets all discs at once:
//   L = sum over p of  K_p tau(0, t_p) f_p(wo, w_p) Phi_p,   K_p = 1 / (pi r_p^2) within r_p of the ray
// with a constant kernel. Photons behind the first surface do not count.
#pragma once

#include "core/geometry/ray_facing_discs.h"
#include "core/scene/ray_walk.h"
#include "core/scene/transmittance_along.h"
#include "gathering/photon_maps/photon.h"
#include "gathering/photon_maps/surface_photon_map.h"

namespace mote::gathering {

/// Light scattered towards the eye along a ray, by the number of its scatterings [W/(m^2 sr)].
struct BeamRadiance {
    core::Rgb single{0.0f};    ///< of photons of depth 1: scattered once
    core::Rgb multiple{0.0f};  ///< of all others
};

/// Photons in media, each with the disc within which rays meet it.
class VolumePhotonMap {
  public:
    VolumePhotonMap() = default;
    /// Radii follow from the distances to the nearest few photons, scaled to hold `estimate.neighbours` of
    /// them. `largest_radius` [m] bounds those of lonely photons.
    VolumePhotonMap(const core::RayQueries& scene, std::vector<Photon> photons,
                    const DensityEstimate& estimate, float largest_radius);

    /// Radiance arriving at ray.t_min along the ray from before `t_max`, its first surface. `state` holds the
    /// media at ray.t_min; context.boundary_hits the boundaries on the ray. From photons of depth up to
    /// `max_depth`. Calls visit(index, term) with each term of the sum.
    template <typename Visit = IgnoreTerms>
    BeamRadiance radiance(const core::Ray& ray, float t_max, const core::MediumState& state, int max_depth,
                          core::WalkContext& context, std::vector<core::RayFacingDiscs::Hit>& scratch,
                          const Visit& visit = {}) const {
        BeamRadiance sum;
        if (photons_.empty()) return sum;
        core::Ray beam = ray;
        beam.t_max = t_max;
        discs_.hits(beam, scratch);
        core::TransmittanceAlong along(beam, state, context.boundary_hits, context.rng, context.tracking);
        for (const core::RayFacingDiscs::Hit& hit : scratch) {
            const Photon& photon = photons_[hit.index];
            if (int(photon.depth) > max_depth) continue;
            const core::Rgb transmittance = along.advance_to(hit.t);
            if (core::is_black(transmittance)) break;
            const core::Rgb light = scattered(hit.index, transmittance, -ray.direction);
            (photon.depth == 1 ? sum.single : sum.multiple) += light;
            visit(hit.index, light);
        }
        return sum;
    }

    std::span<const Photon> photons() const { return photons_; }  ///< by index
    std::size_t size() const { return photons_.size(); }          ///< how many photons
    /// [B]
    std::size_t memory_bytes() const { return photons_.capacity() * sizeof(Photon) + discs_.memory_bytes(); }

  private:
    /// tau f_p Phi_p K_p of a photon.
    core::Rgb scattered(std::uint32_t index, const core::Rgb& transmittance, const core::Vec3& wo) const;

    const core::RayQueries* scene_ = nullptr;
    core::RayFacingDiscs discs_;
    std::vector<Photon> photons_;  ///< in the order of the discs
};

}  // namespace mote::gathering
