// Reference of a study's tiles: the sum over all lights. With a million lights it takes seconds a tile, so
// sums are kept in a file, to which missing ones are appended.
#pragma once

#include "experiments/studies/selection/study.h"

namespace mote::studies {

/// References of the first tiles of the study. Throws std::runtime_error if the file is of other lights or
/// points.
std::vector<Pixels> references_of(const Study& study, const Arguments& a);

}  // namespace mote::studies
