// Exposure of a picture for the eye, by the key value of photographers.
#pragma once

#include <span>

#include "core/math/vec.h"

namespace mote::core {

/// Value at which the log-average of the luminance comes to lie (Reinhard et al. 2002, Eq. 2).
inline constexpr double key_value = 0.18;

/// Stops that bring the log-average luminance of what is lit to `key_value`, but leave at least 97 of 100 of
/// the lit pixels below white. Rounded to hundredths, so that a number in a log gives the same picture again.
/// 0 for a picture that is black or not finite all over.
float adapted_exposure(std::span<const Rgb> pixels);

}  // namespace mote::core
