// The shapes of the scene language: each function hands one or more types to the registry.
#pragma once

#include "core/parameters/add_type.h"

namespace mote::core {

void register_primitives(Registry& registry);  // rectangle, cube
void register_quadrics(Registry& registry);    // sphere, disk, cylinder
void register_instances(Registry& registry);   // shapegroup, instance

/// Where a shape stands, and which side is its outside.
struct ShapePlacement {
    Transform to_world;
    bool flip_normals = false;
};
/// flip_normals and to_world, of which `transforms` says what is allowed.
ParameterList<ShapePlacement> placement_rows(std::string transforms = "Any affine transform.");

/// Runs `make` and gives errors that name no place the place of the element.
template <typename Make>
auto at_element(const Properties& p, Make make) {
    try {
        return make();
    } catch (const InputError& error) {
        if (!error.where().file.empty() || error.where().line > 0) throw;
        throw InputError(error.what(), p.where);
    }
}

}  // namespace mote::core
