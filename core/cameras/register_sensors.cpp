// Hands the sensors to the registry.
#include "core/cameras/sensors.h"

namespace mote::core {

void register_sensors(Registry& registry) {
    register_perspective(registry);
    register_thinlens(registry);
    register_orthographic(registry);
}

}  // namespace mote::core
