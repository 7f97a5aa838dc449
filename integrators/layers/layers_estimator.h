// The passes of `mote_layers`: each is a pass of one of its methods.
#pragma once

#include <memory>
#include <vector>

#include "integrators/layers/layer_methods.h"

namespace mote::integrators {

/// `methods` name their cells (with_cells()); the layers of the film are those of kept_layers(), method i
/// being part i. Part 0 has the seed of the render, the others have seeds of their own: parts are
/// independent.
std::unique_ptr<core::Estimator> make_layers_estimator(const core::Scene& scene,
                                                       const core::RenderOptions& options,
                                                       const std::vector<LayerMethod>& methods);

}  // namespace mote::integrators
