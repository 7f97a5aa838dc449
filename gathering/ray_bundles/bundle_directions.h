// Directions of bundles, and where their grids lie: a Halton sequence in four dimensions, turned by the seed.
#pragma once

#include "core/math/random.h"
#include "core/math/warp.h"

namespace mote::gathering {

struct BundleSample {
    core::Vec3 direction;  ///< uniform over the sphere
    core::Vec2 offset;     ///< uniform over [0,1)^2, for bundle_grid()
};

/// Van der Corput's sequence: the digits of `index` mirrored at the point.
inline double radical_inverse(std::uint32_t base, std::uint64_t index) {
    const double step = 1.0 / base;
    double weight = step, result = 0.0;
    for (; index != 0; index /= base, weight *= step) result += double(index % base) * weight;
    return result;
}

/// Number `index` of the sequence, each dimension shifted by the seed (Cranley & Patterson 1976): the mean
/// over seeds is unbiased, and neighbours vary in both angles (Hermes et al. 2010, Sec. 4.3). A bundle
/// carries light along its direction and against it, so that each solid angle is met with density 1 / (2 pi).
inline BundleSample bundle_sample(std::uint64_t seed, std::uint64_t index) {
    const auto dimension = [&](std::uint32_t base) {
        const double shifted =
            radical_inverse(base, index) + double(core::Rng(core::hash_keys(seed, base)).next_float());
        return std::fmin(float(shifted - std::floor(shifted)), core::one_minus_epsilon);
    };
    return {core::square_to_sphere({dimension(2), dimension(3)}), {dimension(5), dimension(7)}};
}

}  // namespace mote::gathering
