// Hands everything in lights/ to the registry.
#pragma once

namespace mote::core {
class Registry;
}

namespace mote::lights {

/// Every light.
void register_lights(core::Registry& registry);

}  // namespace mote::lights
