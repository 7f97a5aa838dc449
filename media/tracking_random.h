// Random decisions of tracking at more than the 24 bits of a float: in a medium of optical depth 1e-6 a
// collision would otherwise be off by several per cent, and no path would ever pass an optical depth of 17.
#pragma once

#include <cmath>

#include "core/math/random.h"

namespace mote::media {

/// Uniform in (0, 1], with 32 bits in the middle and up to 52 towards both ends.
inline double uniform_double(core::Rng& rng) {
    const std::uint32_t x = rng.next_u32();
    double u = double(x) + 0.5;
    constexpr std::uint32_t edge = 1u << 20;
    if (x + edge < 2 * edge) u = double(x) + (double(rng.next_u32()) + 0.5) * 0x1p-32;  // wraps on purpose
    return u * 0x1p-32;
}

/// Exponentially distributed with mean one: the optical depth to the next event.
inline double sample_optical_depth(core::Rng& rng) { return -std::log(uniform_double(rng)); }

/// True with probability p (values outside [0, 1] count as 0 and 1), exact to 64 bits.
inline bool sample_event(double p, core::Rng& rng) {
    const double scaled = p * 0x1p32;
    const double x = rng.next_u32();
    if (x + 1.0 <= scaled) return true;
    if (x >= scaled) return false;
    return double(rng.next_u32()) * 0x1p-32 < scaled - x;
}

/// optical depth of `length` metres; vacuum of infinite length is 0, not NaN.
inline double optical_depth(double sigma, double length) { return sigma == 0.0 ? 0.0 : sigma * length; }

}  // namespace mote::media
