// Shapes and textures that come from files, for the registry.
#pragma once

#include "core/objects/registry.h"

namespace mote::core {

void register_mesh_files(Registry& registry);   // obj, ply, serialized, mesh
void register_curve_files(Registry& registry);  // bsplinecurve, linearcurve
void register_bitmap_texture(Registry& registry);

/// All of them.
inline void register_assets(Registry& registry) {
    register_mesh_files(registry);
    register_curve_files(registry);
    register_bitmap_texture(registry);
}

}  // namespace mote::core
