#include "lights/selection/register_selection.h"

namespace mote::lights {

void register_selection(core::Registry& registry) {
    registry.add({core::Category::selection,
                  "all",
                  "All virtual point lights at every receiver: brute force.",
                  {},
                  R"(<selection type="all"/>)"},
                 [](const core::Properties&) { return all_vpls(); });
    register_uniform_selection(registry);
    register_lightcuts(registry);
    register_stochastic_selection(registry);
    register_resampling_selection(registry);
    register_matrix_selection(registry);
}

}  // namespace mote::lights
