// Textures: a colour over the unit square of a surface's uv coordinates.
#pragma once

#include <optional>
#include <string>

#include "core/math/vec.h"
#include "core/objects/object.h"

namespace mote::core {

class Texture : public Object {
  public:
    virtual Rgb eval(const Vec2& uv) const = 0;
    /// Mean over the unit square; used for power estimates only.
    virtual Rgb mean() const = 0;
    /// Largest channel value anywhere: used to check that reflectances stay in [0, 1].
    virtual float maximum() const = 0;
    virtual float minimum() const = 0;
    /// The file it came from, for messages; "" where there is none.
    virtual std::string file() const { return ""; }
    /// Same colour everywhere.
    virtual bool constant() const { return false; }
};

}  // namespace mote::core
