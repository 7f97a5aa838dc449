// Cost of passes in counted work: the same on every machine, with any number of threads.
//
// Rays and lookups with fixed weights, in units of one closest hit. The weights are rounded from what the
// loops of this project take where they run at their best (docs/methods/layers.md, "Idea"). Effort allocated
// by them is little worse where they are off by a factor of two, since the best allocation goes with their
// root.
#pragma once

#include "core/render/statistics.h"

namespace mote::core {

/// [closest hits]
double counted_work(const Statistics& statistics);

}  // namespace mote::core
