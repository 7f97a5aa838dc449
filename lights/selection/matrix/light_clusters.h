// All lights of a reduced matrix in clusters, whatever rows they appear in.
//
// Lights that a row sees, lights that are hidden from all and lights that face away from all are clustered
// apart: the first two share the columns in proportion to the root of what they cost, the last, which have no
// column to be compared by, are neighbours in their order, of equal weight, a sixteenth of the columns.
#pragma once

#include "lights/selection/matrix/matrix_rows.h"

namespace mote::lights {

/// Every light with energy is in one of about `columns` clusters, at least one of each class that there is.
/// Throws core::Cancelled.
ColumnClusters cluster_lights(const ReducedMatrix& matrix, std::size_t columns, core::Rng& rng,
                              core::CancelToken cancelled = {});

}  // namespace mote::lights
