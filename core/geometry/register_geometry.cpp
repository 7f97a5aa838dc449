// Hands the shapes of this folder to the registry. Bsdf, emitter and media of a shape are nested elements
// that the scene loader attaches.
#include "core/geometry/shape_plugins.h"

namespace mote::core {

Parameter to_world_parameter(const std::string& description) {
    return {"to_world", "transform", "identity", description};
}

Parameter flip_normals_parameter() { return {"flip_normals", "boolean", "false", "turn the outside in"}; }

void register_geometry(Registry& registry) {
    register_primitives(registry);
    register_quadrics(registry);
    register_instances(registry);
}

}  // namespace mote::core
