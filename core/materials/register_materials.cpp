// Hands the BSDFs and textures of this folder to the registry, by name: static registration gets lost in
// static libraries.
#include "core/materials/register_materials.h"

namespace mote::core {

void register_materials(Registry& registry) {
    register_diffuse(registry);
    register_conductor(registry);
    register_rough_conductor(registry);
    register_dielectric(registry);
    register_thin_dielectric(registry);
    register_rough_dielectric(registry);
    register_plastic(registry);
    register_rough_plastic(registry);
    register_phong(registry);
    register_principled(registry);
    register_null(registry);
    register_twosided(registry);
    register_blend(registry);
    register_mask(registry);
    register_normal_map(registry);
    register_bump_map(registry);
    register_checkerboard_texture(registry);
    register_mesh_attribute_texture(registry);
}

}  // namespace mote::core
