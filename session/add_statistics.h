// Statistics of passes that several runs rendered.
#pragma once

#include "core/render/statistics.h"

namespace mote::session {

/// Adds the counts of one run to those of another. Values that are no counts keep the larger one; the noise
/// stays, for the film of the sum has it.
void add_statistics(core::Statistics& sum, const core::Statistics& more);

}  // namespace mote::session
