// Textures: a colour over the unit square of a surface's uv coordinates.
#pragma once

#include <optional>
#include <string>

#include "core/materials/texture_coordinates.h"
#include "core/objects/object.h"

namespace mote::core {

class Texture : public Object {
  public:
    /// The value at a place.
    virtual Rgb eval(const TextureCoordinates& uv) const = 0;
    /// One number, where a roughness or a weight is needed: a picture's luminance.
    virtual float scalar(const TextureCoordinates& uv) const { return luminance(eval(uv)); }
    /// Derivatives of scalar() by u and v: zero for what is constant piece by piece.
    virtual Vec2 scalar_gradient(const TextureCoordinates& /*uv*/) const { return {0.0f, 0.0f}; }
    /// Mean over the unit square; used for power estimates only.
    virtual Rgb mean() const = 0;
    /// Largest channel value anywhere: used to check that reflectances stay in [0, 1].
    virtual float maximum() const = 0;
    virtual float minimum() const = 0;
    /// The file it came from, for messages; "" where there is none.
    virtual std::string file() const { return ""; }
    /// The mean over a shape with attributes, where it depends on them.
    virtual Rgb mean_over(const SurfaceAttributes&) const { return mean(); }
    /// Same colour everywhere.
    virtual bool constant() const { return false; }
};

/// A texture that others share.
using TexturePtr = std::shared_ptr<const Texture>;

/// A texture of one value.
std::shared_ptr<Texture> make_constant_texture(const Rgb& value);

}  // namespace mote::core
