#include "lights/register_lights.h"

#include "lights/emitters/emitters.h"

namespace mote::lights {

void register_lights(core::Registry& registry) {
    register_point(registry);
    register_spot(registry);
    register_projector(registry);
    register_directional(registry);
    register_area(registry);
    register_constant(registry);
    register_envmap(registry);
}

}  // namespace mote::lights
