// Hands the shapes of this folder to the registry. Bsdf, emitter and media of a shape are nested elements
// that the scene loader attaches.
#include "core/geometry/shape_plugins.h"

namespace mote::core {

ParameterList<ShapePlacement> placement_rows(std::string transforms) {
    return {row("flip_normals", &ShapePlacement::flip_normals, "Turn the outside in."),
            row("to_world", &ShapePlacement::to_world, std::move(transforms))};
}

void register_geometry(Registry& registry) {
    register_primitives(registry);
    register_quadrics(registry);
    register_instances(registry);
}

}  // namespace mote::core
