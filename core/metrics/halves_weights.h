// Weights of errors (relative_error.h, Eq. 1) of a picture whose light is known from two halves of its
// passes.
//
// |r|^2 of a pixel is the median of its neighbours' <a, b>, 5 x 5 pixels, whose mean has no noise in it since
// the halves are independent; or |r|^2 of the darker half where it is brighter, such as a lamp. By the mean
// of the halves, a rare bright path or a small lamp that one half has missed would be taken for a bright
// place, where an error counts for little.
#pragma once

#include "core/metrics/relative_error.h"

namespace mote::core {

/// `a`, `b`: what is shown of the halves, row by row. Throws std::invalid_argument when a size does not fit.
RelativeWeights weights_of_halves(std::span<const Rgb> a, std::span<const Rgb> b, int width, int height);

}  // namespace mote::core
