#include "session/registry.h"

#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "media/register_media.h"

namespace mote::session {

core::Registry make_registry() {
    core::Registry registry;
    core::register_core(registry);
    media::register_media(registry);
    lights::register_lights(registry);
    integrators::register_integrators(registry);
    return registry;
}

}  // namespace mote::session
