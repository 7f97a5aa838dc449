// Hands everything in core/ to the registry.
#include "core/cameras/film_objects.h"
#include "core/formats/register_formats.h"
#include "core/objects/registry.h"

namespace mote::core {

void register_core(Registry& registry) {
    register_materials(registry);
    register_geometry(registry);
    register_assets(registry);
    register_sensors(registry);
    register_film_objects(registry);
}

}  // namespace mote::core
