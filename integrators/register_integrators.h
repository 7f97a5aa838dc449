// Hands everything in integrators/ to the registry.
#pragma once

namespace mote::core {
class Registry;
}

namespace mote::integrators {

/// Every integrator.
void register_integrators(core::Registry& registry);

}  // namespace mote::integrators
