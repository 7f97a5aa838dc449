// The shapes of the scene language: each function hands one or more types to the registry.
#pragma once

#include "core/objects/properties.h"
#include "core/objects/registry.h"

namespace mote::core {

void register_primitives(Registry& registry);  // rectangle, cube
void register_quadrics(Registry& registry);    // sphere, disk, cylinder
void register_instances(Registry& registry);   // shapegroup, instance

/// The rows of the manual pages that many shapes share.
Parameter to_world_parameter(const std::string& description);
Parameter flip_normals_parameter();

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
