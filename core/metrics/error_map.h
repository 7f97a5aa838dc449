// Where a picture differs from its reference, in false colours.
//
// Shown is |d| sqrt(w) with the weights of relative_error.h, on a logarithmic scale: what the error is made
// of. The colours are those of viridis (matplotlib, in the public domain): lightness rises evenly with the
// error, so they keep their order in grey and for most people who see colours differently. Pixels that are
// not finite are magenta, which viridis has not.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

struct ErrorScale {
    double lowest = 1e-3, highest = 1.0;  ///< relative errors at the two ends; beyond them the ends' colours
};
inline constexpr const char* error_map_definition =
    "sqrt(w) |d|, logarithmic, dark violet to yellow; magenta where a value is not finite";

/// Linear RGB for write_png(), pixel by pixel; where the reference is black all over, every error is large.
/// Throws std::invalid_argument for pictures of different sizes
/// or a scale without 0 < lowest < highest.
std::vector<Rgb> error_map(std::span<const Rgb> image, std::span<const Rgb> reference, int width, int height,
                           const ErrorScale& scale = {});

}  // namespace mote::core
