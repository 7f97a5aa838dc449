// Textures as declared parameters: an rgb, a float or a nested texture, whose values lie in the row's range.
#pragma once

#include "core/materials/texture.h"
#include "core/parameters/add_type.h"

namespace mote::core {

const ValueKind& kind_of(Type<TexturePtr>);

}  // namespace mote::core
