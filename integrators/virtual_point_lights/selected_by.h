// What a pass selects its virtual point lights by.
#pragma once

#include "lights/selection/light_hierarchy.h"
#include "lights/selection/light_tree.h"
#include "lights/selection/matrix_selection.h"
#include "lights/selection/power_candidates.h"

namespace mote::integrators {

/// Null: not by this. All null: all lights are looked at.
struct SelectedBy {
    const lights::LightHierarchy* hierarchy = nullptr;  ///< for cuts
    const lights::LightTree* tree = nullptr;            ///< to draw from
    const lights::PowerCandidates* power = nullptr;     ///< candidates by power
    const lights::MatrixSelection* matrix = nullptr;    ///< groups of its columns
};

}  // namespace mote::integrators
