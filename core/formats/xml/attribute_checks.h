// Checks that shapes with textures of type mesh_attribute have those attributes.
#pragma once

#include "core/formats/xml/element_checks.h"
#include "core/geometry/shape.h"

namespace mote::core {

/// Throws InputError, at the texture, where a BSDF or light nested in `element` requires an attribute that
/// `shape` has not, or that holds values which are no reflectances (in a BSDF) or negative (in a light).
/// Precondition: the nested objects have been made, so that nothing refers to itself.
void check_mesh_attributes(const Element& element, const Shape& shape, const IdTable& ids);

}  // namespace mote::core
