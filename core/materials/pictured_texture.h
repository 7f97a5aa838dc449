// Textures that show a picture with a size of its own.
#pragma once

#include "core/math/vec.h"

namespace mote::core {

/// A texture with the size of its picture. Others have none: they are as square as the unit square.
class PicturedTexture {
  public:
    virtual ~PicturedTexture() = default;
    virtual glm::ivec2 resolution() const = 0;  ///< columns and rows
};

}  // namespace mote::core
