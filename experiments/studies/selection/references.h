// What the tiles of a study are held against: the light of all lights. Of a million that takes seconds a
// tile, so sums are kept in a file, which grows by what is not in it yet.
#pragma once

#include "experiments/studies/selection/study.h"

namespace mote::studies {

/// Of the first tiles of the study. Throws std::runtime_error where the file is of other lights or points.
std::vector<Pixels> references_of(const Study& study, const Arguments& a);

}  // namespace mote::studies
