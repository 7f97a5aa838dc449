// A texture as a BSDF holds it: constant ones, which are most, are read without a virtual call.
#pragma once

#include <memory>

#include "core/materials/texture.h"

namespace mote::core {

class TextureSlot {
  public:
    /// A null texture stands for the constant `value`.
    explicit TextureSlot(std::shared_ptr<const Texture> texture, const Rgb& value = Rgb(1.0f))
        : texture_(std::move(texture)),
          constant_(!texture_ || texture_->constant()),
          value_(!texture_ ? value : (constant_ ? texture_->eval({0.0f, 0.0f}) : Rgb(0.0f))) {}

    Rgb eval(const Vec2& uv) const { return constant_ ? value_ : texture_->eval(uv); }
    bool textured() const { return !constant_; }
    Rgb mean() const { return constant_ ? value_ : texture_->mean(); }
    /// Largest channel anywhere.
    float maximum() const { return constant_ ? max_component(value_) : texture_->maximum(); }

  private:
    std::shared_ptr<const Texture> texture_;
    bool constant_;
    Rgb value_;
};

}  // namespace mote::core
