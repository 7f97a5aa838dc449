// Unbiased ray marching through a grid (Kettunen et al. 2021): an optical depth by equal steps from a random
// start is right in the mean, and exp_of_mean() makes a transmittance of it.
//
// Where steps are short against the extinction hardly anything random is left, unlike in tracking, whose
// tentative collisions are a few at random places.
#pragma once

#include "media/exp_of_mean.h"
#include "media/tracked_medium.h"

namespace mote::media {

namespace detail {

/// Steps per optical depth of the majorant.
inline constexpr double steps_per_depth = 0.7;
/// Rays that need more are tracked.
inline constexpr double max_steps = 96.0;

}  // namespace detail

template <typename Grid>
core::Rgb TrackedMedium<Grid>::by_unbiased_marching(const core::Ray& ray, core::Rng& rng,
                                                    core::TrackingCounters& counters) const {
    const core::Vec3d origin = index_origin(ray), direction = index_direction(ray);
    double begin, end;
    if (majorant_ == 0.0f || !clip(ray, begin, end)) return core::Rgb(1.0f);
    const bool bounded = ends_with_cells();
    if (bounded && !grid_.majorants.clip(origin, direction, begin, end)) return core::Rgb(1.0f);
    const double wanted = std::ceil(detail::steps_per_depth * double(majorant_) * (end - begin));
    if (!(wanted <= detail::max_steps)) return by_residual_tracking(ray, rng, counters);
    const int steps = (std::max(int(wanted), 1) + VoxelCopy::width - 1) / VoxelCopy::width * VoxelCopy::width;
    const double length = (end - begin) / double(steps);
    const core::Vec3d from = origin + begin * direction, step = length * direction;
    MeanEstimates<Wide> depths;
    const std::size_t count = sample_estimates(rng);
    for (std::size_t i = 0; i < count; ++i) {
        const double first = uniform_double(rng);
        Wide mean(0.0);
        if constexpr (!chromatic)
            if (bounded && !copy_.empty()) mean = double(copy_.mean_along(from, step, float(first), steps));
        if (!bounded || copy_.empty()) {
            auto cursor = grid_.cursor();
            for (int k = 0; k < steps; ++k)
                mean += detail::widen(cursor.lookup(from + (double(k) + first) * step)) / double(steps);
        }
        depths[i] = -mean * ((end - begin) * double(parts_.scale));
    }
    counters.lookups += count * std::size_t(steps);
    return core::Rgb(exp_of_mean(depths, count));
}

}  // namespace mote::media
