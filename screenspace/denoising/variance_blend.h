// Weight of a denoised picture against the noisy one, from the variance that the film measured.
//
// With b the bias of a denoised pixel and v the variance of the noisy one, y + g (x - y) has the least mean
// square error, b^2 v / (b^2 + v), for g = b^2 / (b^2 + v): never above v nor b^2. Over a window
// sum (x - y)^2 has the mean sum b^2 + sum v (noise that y shares with x aside), so
//   g = max(0, 1 - sum v / sum (x - y)^2).                                                               (1)
// That sum is noise itself, of a variance near 2 sum v^2, so what lies within `deviations` standard
// deviations counts for nothing:
//   g = max(0, 1 - (sum v + deviations sqrt(2 sum v^2)) / sum (x - y)^2).                                (2)
// With many passes v vanishes, g becomes 1 and the picture converges to the mean,
// whatever the denoiser does.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::screenspace {

/// `noisy`: a mean of passes, `variance`: of that mean. The windows have (2 radius + 1)^2 pixels, which count
/// by their relative error. Pixels without a finite value or variance stay denoised. Throws
/// std::invalid_argument when sizes differ.
std::vector<core::Rgb> blend_by_variance(int width, int height, std::span<const core::Rgb> denoised,
                                         std::span<const core::Rgb> noisy,
                                         std::span<const core::Rgb> variance, int radius = 3,
                                         float deviations = 0.0f);

}  // namespace mote::screenspace
