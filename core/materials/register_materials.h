// The plugins of this folder: each registers its manual page and factory. Called by register_materials().
#pragma once

#include "core/objects/registry.h"

namespace mote::core {

void register_diffuse(Registry& registry);
void register_conductor(Registry& registry);
void register_rough_conductor(Registry& registry);
void register_dielectric(Registry& registry);
void register_thin_dielectric(Registry& registry);
void register_rough_dielectric(Registry& registry);
void register_plastic(Registry& registry);
void register_rough_plastic(Registry& registry);
void register_phong(Registry& registry);
void register_principled(Registry& registry);  // and "principledthin"
void register_null(Registry& registry);
void register_twosided(Registry& registry);
void register_blend(Registry& registry);
void register_mask(Registry& registry);
void register_normal_map(Registry& registry);
void register_bump_map(Registry& registry);
void register_checkerboard_texture(Registry& registry);
void register_mesh_attribute_texture(Registry& registry);

}  // namespace mote::core
