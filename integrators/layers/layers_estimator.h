// The passes of `mote_layers`: each is a pass of one of its methods.
#pragma once

#include <memory>
#include <vector>

#include "integrators/layer_filter/layer_filter.h"
#include "integrators/layers/layer_methods.h"

namespace mote::integrators {

/// `filter`: of layers of the film, in image space. `shares`: passes of each part in a round; empty: as many
/// as reduce the error fastest. Part 0 has the seed of the render, the others have seeds of their own: parts
/// are independent.
std::unique_ptr<core::Estimator> make_layers_estimator(const core::Scene& scene,
                                                       const core::RenderOptions& options,
                                                       const LayerChoice& choice, LayerFilter filter,
                                                       const std::vector<std::uint32_t>& shares);

}  // namespace mote::integrators
