// Media whose coefficients vary over space: what they share, whatever grid holds the extinction.
//
// The tracking loops are in tracked_medium.h, compiled once per kind of grid.
#pragma once

#include <memory>
#include <span>

#include "core/scene/medium.h"
#include "media/emission.h"
#include "media/medium_emitter.h"
#include "media/tracking_settings.h"

namespace mote::core {
class Registry;
}

namespace mote::media {

class Volume;

/// Properties of a medium except the grid of its extinction.
struct MediumParts {
    float scale = 1.0f;                          ///< multiplies the grid's values to give sigma_t [1/m]
    std::shared_ptr<const Volume> albedo;        ///< single-scattering albedo, 0 to 1
    std::shared_ptr<core::PhaseFunction> phase;  ///< not null
    Emission emission;                           ///< how it glows
    TrackingSettings tracking;                   ///< which estimators
    /// Tentative collisions of one segment after which a walk is ended and counted as a fallback:
    /// transmittances take the rest by ray marching, a path that looks for a collision is lost (throughput
    /// 0), which darkens, rather than spins. 2^24 take 0.8 s; they pass an optical depth of 16 in a
    /// part a million times thinner than its majorant.
    std::uint64_t step_limit = std::uint64_t(1) << 24;
    /// Multiplies all majorants, for tests of wrong and of loose ones; 1 in every other use. Any other value
    /// also turns regular tracking off.
    float plant_majorant_factor = 1.0f;
};

/// Base of media over grids.
class HeterogeneousMedium : public core::Medium {
  public:
    const core::PhaseFunction& phase() const override { return *parts_.phase; }
    std::shared_ptr<core::Emitter> make_emitter(const core::Bounds3& box) override;

    /// Estimator of Medium::transmittance(): settings.transmittance, or the choice of `automatic`.
    TransmittanceEstimator estimator() const { return estimator_; }
    /// The transmittance by a chosen estimator (`automatic` is estimator()); all but ray marching are
    /// unbiased.
    virtual core::Rgb transmittance_by(TransmittanceEstimator estimator, const core::Ray& ray, core::Rng& rng,
                                       core::TrackingCounters& counters) const = 0;
    core::Rgb transmittance(const core::Ray& ray, core::Rng& rng,
                            core::TrackingCounters& counters) const override {
        return transmittance_by(estimator_, ray, rng, counters);
    }

    float marching_step(float voxels, float) const override { return voxels * voxel_size_; }
    core::Vec3d optical_depth_along(const core::Ray& ray, float voxels,
                                    core::TrackingCounters& counters) const override {
        return optical_depth_by_marching(ray, voxels * voxel_size_, counters);
    }
    void optical_depths_along(const core::Ray& ray, float voxels, std::span<core::Vec3d> depths,
                              core::TrackingCounters& counters) const override {
        optical_depths_by_marching(ray, voxels * voxel_size_, depths, counters);
    }

    /// Optical depth per channel by the midpoint rule: deterministic, biased by the step. The segment,
    /// clipped to the grid where the medium ends there, is cut into equal steps of at most `step` metres. The
    /// segment must be finite unless the medium is bounded.
    virtual core::Vec3d optical_depth_by_marching(const core::Ray& ray, float step,
                                                  core::TrackingCounters& counters) const = 0;
    /// Optical depths from ray.t_min to the end of each of depths.size() equal parts of a finite segment, in
    /// one walk that leaps over empty cells.
    virtual void optical_depths_by_marching(const core::Ray& ray, float step, std::span<core::Vec3d> depths,
                                            core::TrackingCounters& counters) const = 0;

  protected:
    explicit HeterogeneousMedium(MediumParts parts);  ///< volumes and phase function that it takes over
    core::Rgb albedo_at(const core::Vec3& p) const;   ///< single-scattering albedo [1]

    MediumParts parts_;                         ///< as given
    std::optional<core::Rgb> constant_albedo_;  ///< where it is the same everywhere
    bool emissive_, absorbs_alone_;             ///< emits; neither scatters nor emits
    TransmittanceEstimator estimator_ = TransmittanceEstimator::residual_ratio_tracking;  ///< of connections
    float voxel_size_ = core::infinity;                                                   ///< of the grid [m]
    std::shared_ptr<MediumEmitter> emitter_;  ///< null until make_emitter()
};

void register_heterogeneous_medium(core::Registry& registry);  ///< <medium type="heterogeneous">.

}  // namespace mote::media
