// The filtered sum of several layers, of which each keeps its fraction of a pixel.
#pragma once

#include <vector>

#include "integrators/layer_filter/layer_of_passes.h"
#include "screenspace/layer_filter/view_filter.h"

namespace mote::integrators {

/// The layers' shares of the filtered sum, one after the other. Where a pixel has no light they have those
/// of the whole picture. `layers` must not be empty. Throws as ViewFilter::filtered().
std::vector<std::vector<core::Rgb>> filtered_sum(screenspace::ViewFilter& filter,
                                                 std::vector<LayerOfPasses> layers,
                                                 screenspace::LayerKind kind,
                                                 screenspace::FilterQuality quality,
                                                 core::CancelToken cancelled);

}  // namespace mote::integrators
