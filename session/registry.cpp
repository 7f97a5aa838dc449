#include "session/registry.h"

#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "media/register_media.h"
#include "session/plugins.h"

namespace mote::session {

core::Registry make_registry(std::span<const std::string> plugins) {
    core::Registry registry;
    core::register_core(registry);
    media::register_media(registry);
    lights::register_lights(registry);
    integrators::register_integrators(registry);
    for (const std::string& file : plugin_files(plugins)) load_plugin(registry, file);
    return registry;
}

}  // namespace mote::session
