// The passes of `mote_layers`: each is a pass of one of its methods.
#pragma once

#include <memory>
#include <vector>

#include "integrators/layer_filter/layer_filter.h"
#include "integrators/layers/layer_methods.h"

namespace mote::integrators {

/// What of a picture is filtered in image space, and how.
struct FilterPlan {
    LayerFilterParameters parameters;
    std::vector<LayerFilter::Choice> layers;  ///< of the film; none: nothing is filtered
};

/// `shares`: passes of each part in a round, instead of as many as reduce the error fastest; empty: the
/// latter. `methods` name their cells (with_cells()); the layers of the film are those of kept_layers(),
/// method i being part i. Part 0 has the seed of the render, the others have seeds of their own: parts are
/// independent.
std::unique_ptr<core::Estimator> make_layers_estimator(const core::Scene& scene,
                                                       const core::RenderOptions& options,
                                                       const std::vector<LayerMethod>& methods,
                                                       const FilterPlan& filter,
                                                       const std::vector<std::uint32_t>& shares);

}  // namespace mote::integrators
