// Hands every selection of virtual point lights to the registry.
#pragma once

namespace mote::core {
class Registry;
}

namespace mote::lights {

/// all, uniform, lightcuts, multidimensional_lightcuts, stochastic_lightcuts, light_tree, resampling, matrix.
void register_selection(core::Registry& registry);

void register_uniform_selection(core::Registry& registry);

}  // namespace mote::lights
