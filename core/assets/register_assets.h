// Shapes and textures that come from files, for the registry.
#pragma once

#include "core/objects/registry.h"

namespace mote::core {

void register_mesh_files(Registry& registry);  // obj, ply, mesh
void register_bitmap_texture(Registry& registry);

}  // namespace mote::core
