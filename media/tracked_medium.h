// Delta and ratio tracking through a grid, compiled for each kind of grid.
//
// The majorant is one number per cell, the largest channel's: a tentative collision of its Poisson process is
// real with the probability sigma_t,h / majorant of the hero channel h. Since the exponential of the majorant
// is the same in every channel it cancels from all ratios of densities, and PathWeights changes at tentative
// collisions only (Woodcock et al. 1965; Miller et al. 2019; pbrt-v4, section 14.2).
//
// Where a cell's bounds are dense and far apart the ray goes from voxel to voxel instead
// (regular_tracking.h).
//
// Grid must provide: Value (float: grey, or Rgb), world_to_index, cursor() with lookup(index position),
// trilinear between integers, majorants, description; and, where the medium ends before the grid's values do,
// box (a WorldBox).
#pragma once

#include <fmt/format.h>

#include <type_traits>

#include "core/math/transform.h"
#include "media/heterogeneous_medium.h"
#include "media/majorant_grid.h"
#include "media/regular_tracking.h"
#include "media/tracking_random.h"
#include "media/voxel_copy.h"

namespace mote::media {

namespace detail {

inline double channel(double v, int) { return v; }
inline double channel(const core::Vec3d& v, int c) { return v[c]; }
inline void clear_channel(double& v, int) { v = 0.0; }
inline void clear_channel(core::Vec3d& v, int c) { v[c] = 0.0; }
inline double widen(float v) { return v; }
inline core::Vec3d widen(const core::Rgb& v) { return core::Vec3d(v); }
inline double largest(double v) { return v; }
inline double largest(const core::Vec3d& v) { return std::fmax(v.x, std::fmax(v.y, v.z)); }
inline double smallest(float v) { return v; }
inline double smallest(const core::Rgb& v) { return std::fmin(v.x, std::fmin(v.y, v.z)); }
inline double exp_minus(double v) { return std::exp(-v); }
inline core::Vec3d exp_minus(const core::Vec3d& v) { return glm::exp(-v); }
inline core::Rgb exp_minus_rgb(double v) { return core::Rgb(float(std::exp(-v))); }
inline core::Rgb exp_minus_rgb(const core::Vec3d& v) {
    return {float(std::exp(-v.x)), float(std::exp(-v.y)), float(std::exp(-v.z))};
}

/// Below this weight a ratio-tracking walk survives by chance (Russian roulette), so that it ends soon in a
/// medium much thinner than its majorant. Survivors carry the threshold itself: no weight ever grows.
inline constexpr double roulette_threshold = 1e-3;

/// Returns false when the walk dies.
template <typename Wide>
bool russian_roulette(Wide& weight, core::Rng& rng) {
    const double w = largest(weight);
    if (w >= roulette_threshold) return true;
    const double survival = w / roulette_threshold;
    if (!sample_event(survival, rng)) {
        weight = Wide(0.0);
        return false;
    }
    weight /= survival;
    return true;
}

}  // namespace detail

template <typename Grid>
class TrackedMedium final : public HeterogeneousMedium {
  public:
    using Value = typename Grid::Value;
    using Wide = std::conditional_t<std::is_same_v<Value, float>, double, core::Vec3d>;
    using Range = typename MajorantGrid<Value>::Range;
    static constexpr bool chromatic = !std::is_same_v<Value, float>;
    static constexpr bool boxed = requires(Grid grid) { grid.box; };

    TrackedMedium(Grid grid, MediumParts parts)
        : HeterogeneousMedium(std::move(parts)), grid_(std::move(grid)) {
        grid_.majorants.scale_upper(parts_.plant_majorant_factor);
        certain_fraction_ = grid_.majorants.certain_fraction();
        estimator_ = parts_.tracking.transmittance;
        if (estimator_ == TransmittanceEstimator::automatic)
            estimator_ = certain_fraction_ == 1.0 ? TransmittanceEstimator::residual_ratio_tracking
                                                  : TransmittanceEstimator::unbiased_ray_marching;
        majorant_ = float(detail::largest(grid_.majorants.total().upper) * double(parts_.scale));
        if (majorant_ == 0.0f) return;
        voxel_size_ = find_voxel_size();
        if constexpr (!chromatic)
            if (estimator_ == TransmittanceEstimator::unbiased_ray_marching && ends_with_cells()) {
                auto cursor = grid_.cursor();
                copy_ = VoxelCopy(grid_.majorants.lower(), grid_.majorants.upper(),
                                  [&](const Voxel& v) { return cursor.lookup(core::Vec3d(v)); });
            }
        if (parts_.plant_majorant_factor == 1.0f)
            regular_from_ = detail::regular_depth_per_voxel / (double(voxel_size_) * double(parts_.scale));
    }

    core::MediumTraits traits() const override;
    core::MediumCoefficients coefficients(const core::Vec3& p) const override;
    float majorant() const override { return majorant_; }
    core::Bounds3 bounds() const override;

    std::optional<float> sample_collision(const core::Ray& ray, core::PathWeights& weights,
                                          core::Rgb& emitted, core::Rng& rng,
                                          core::TrackingCounters& counters) const override;
    void scatter_along(const core::Ray& ray, core::PathWeights& weights, core::Rgb& emitted,
                       core::ScatteringPoints& points, core::Rng& rng,
                       core::TrackingCounters& counters) const override;
    void connect(const core::Ray& ray, core::PathWeights& weights, core::Rng& rng,
                 core::TrackingCounters& counters) const override;
    core::Rgb transmittance_by(TransmittanceEstimator estimator, const core::Ray& ray, core::Rng& rng,
                               core::TrackingCounters& counters) const override;
    core::Vec3d optical_depth_by_marching(const core::Ray& ray, float step,
                                          core::TrackingCounters& counters) const override;
    void optical_depths_by_marching(const core::Ray& ray, float step, std::span<core::Vec3d> depths,
                                    core::TrackingCounters& counters) const override;

  private:
    /// Walks the Poisson process with rate `rate_of(range)` along the ray: `at_collision(range, rate, t,
    /// density) -> bool` (false stops) for every tentative collision, `at_piece(range, length)` for every
    /// piece that was passed. Rates and densities are in the grid's own unit; the scale is applied to
    /// lengths. At the step limit the walk ends: the t up to which it came. Pieces that are better tracked
    /// regularly go to `at_voxels(voxels, t0, t1) -> bool` instead. `next_gap()` is the optical depth to the
    /// next event, where that is not a tentative collision alone.
    template <typename RateOf, typename AtPiece, typename AtCollision, typename AtVoxels, typename NextGap>
    std::optional<double> track(const core::Ray& ray, core::TrackingCounters& counters, RateOf&& rate_of,
                                AtPiece&& at_piece, AtCollision&& at_collision, AtVoxels&& at_voxels,
                                NextGap&& next_gap) const;
    template <typename RateOf, typename AtPiece, typename AtCollision, typename AtVoxels>
    std::optional<double> track(const core::Ray& ray, core::Rng& rng, core::TrackingCounters& counters,
                                RateOf&& rate_of, AtPiece&& at_piece, AtCollision&& at_collision,
                                AtVoxels&& at_voxels) const {
        return track(ray, counters, rate_of, at_piece, at_collision, at_voxels,
                     [&] { return sample_optical_depth(rng); });
    }
    /// The strata for so many samples along a ray: the majorants' optical depth shared out among them.
    double stratum_along(const core::Ray& ray, int samples) const;

    /// The voxels along a ray, for regular tracking; counts lookups.
    class Voxels;
    bool far_apart(const Range& range) const {
        return detail::regular_contrast * detail::smallest(range.lower) < detail::largest(range.upper) &&
               &range != &grid_.majorants.outside();
    }
    /// Regular tracking of sample_collision(): true when the path passes.
    bool pass_voxels(const Voxels& voxels, double t0, double t1, const core::Ray& ray,
                     core::PathWeights& weights, core::Rgb& emitted, core::Rng& rng,
                     std::optional<float>& found) const;

    /// The transmittance from where a walk was given up to the end, by marching; 1 where none was. An
    /// estimate stopped there and multiplied by it keeps its mean, but for marching's tolerance.
    core::Rgb rest_by_marching(const core::Ray& ray, const std::optional<double>& from,
                               core::TrackingCounters& counters) const;

    core::Rgb by_marching(const core::Ray& ray, core::TrackingCounters& counters) const;
    core::Rgb by_delta_tracking(const core::Ray& ray, core::Rng& rng, core::TrackingCounters& counters) const;
    core::Rgb by_ratio_tracking(const core::Ray& ray, core::Rng& rng, core::TrackingCounters& counters) const;
    core::Rgb by_residual_tracking(const core::Ray& ray, core::Rng& rng,
                                   core::TrackingCounters& counters) const;
    core::Rgb by_unbiased_marching(const core::Ray& ray, core::Rng& rng,
                                   core::TrackingCounters& counters) const;

    /// The part of the segment that can hold the medium; false when there is none.
    bool clip(const core::Ray& ray, double& t0, double& t1) const {
        t0 = ray.t_min, t1 = ray.t_max;
        if constexpr (boxed) return grid_.box.clip(ray, t0, t1);
        return true;
    }
    /// Nothing is outside of the majorants' cells.
    bool ends_with_cells() const {
        return grid_.majorants.has_cells() && detail::largest(grid_.majorants.outside().upper) == 0.0;
    }
    core::Vec3d index_origin(const core::Ray& ray) const {
        return grid_.world_to_index.point(core::Vec3d(ray.origin));
    }
    core::Vec3d index_direction(const core::Ray& ray) const {
        return grid_.world_to_index.vector(core::Vec3d(ray.direction));
    }

    float find_voxel_size() const;

    Grid grid_;
    VoxelCopy copy_;  ///< for unbiased ray marching through one channel, where it is not too large
    float majorant_ = 0.0f;
    /// Rate from which a cell may be tracked regularly, wherever a ray ends, so that two techniques agree.
    double regular_from_ = core::infinity;
    double certain_fraction_ = 0.0;  ///< of the majorants: a sum over all cells, taken once
};

}  // namespace mote::media

#include "media/tracked_medium_impl.h"
#include "media/tracked_scattering_impl.h"
#include "media/unbiased_marching_impl.h"
