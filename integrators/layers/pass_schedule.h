// Schedule of passes: the part of a picture that has the next one, so that the error of the whole falls
// fastest for the work.
//
// With a variance s_i^2 of one pass of part i and w_i its work, n_i passes leave the error sum s_i^2 / n_i at
// the cost sum n_i w_i. One more pass of part i takes s_i^2 / (n_i (n_i + 1)) for w_i; always taking
// the best of these leads to n_i ~ s_i / sqrt(w_i). Variances and work are those that the film has recorded
// so far (Film::work): the schedule is a function of the film alone.
#pragma once

#include <span>

#include "core/film/film.h"

namespace mote::integrators {

/// `left[i]` is the share of part i's variance that stays in the picture: below 1 where it is filtered.
/// Errors are relative to the picture around them, as everywhere (core/metrics/relative_error.h).
std::size_t next_part(const core::Film& film, std::span<const double> left);

}  // namespace mote::integrators
