// Cost of passes in counted work: the same on every machine, with any number of threads.
//
// Rays and lookups with fixed weights, in units of one closest hit. The weights are rounded from what the
// loops of this project take: a closest hit some 500 ns, a density lookup 8 to 20. Effort allocated by them
// is little worse where they are off by a factor of two, since the best allocation goes with their root.
#pragma once

#include "core/render/statistics.h"

namespace mote::core {

inline constexpr double work_of_occlusion = 0.5;      ///< of a shadow ray, or to boundaries [closest hits]
inline constexpr double work_of_lookup = 1.0 / 32.0;  ///< of a density [closest hits]

/// [closest hits]
double counted_work(const Statistics& statistics);

}  // namespace mote::core
