// The passes of bidirectional path tracing: one eye path and one light path for each pixel.
#pragma once

#include "integrators/bidirectional/strategies.h"

namespace mote::integrators {

std::unique_ptr<core::Estimator> make_bidirectional_estimator(const core::Scene& scene,
                                                              const core::RenderOptions& options,
                                                              const BidirectionalSettings& settings);

}  // namespace mote::integrators
