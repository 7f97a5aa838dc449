// A texture as a BSDF holds it: constant ones, which are most, are read without a virtual call.
#pragma once

#include <memory>

#include "core/materials/texture.h"

namespace mote::core {

class TextureSlot {
  public:
    /// The texture must not be null.
    explicit TextureSlot(TexturePtr texture)
        : texture_(std::move(texture)),
          constant_(texture_->constant()),
          value_(constant_ ? texture_->eval({0.0f, 0.0f}) : Rgb(0.0f)) {}

    Rgb eval(const TextureCoordinates& uv) const { return constant_ ? value_ : texture_->eval(uv); }
    bool textured() const { return !constant_; }
    Rgb mean() const { return constant_ ? value_ : texture_->mean(); }
    /// Largest channel anywhere.
    float maximum() const { return constant_ ? max_component(value_) : texture_->maximum(); }

  private:
    TexturePtr texture_;
    bool constant_;
    Rgb value_;
};

/// A texture of one number: Texture::scalar().
class ScalarSlot {
  public:
    /// The texture must not be null.
    explicit ScalarSlot(TexturePtr texture)
        : texture_(std::move(texture)),
          constant_(texture_->constant()),
          value_(constant_ ? texture_->scalar({0.0f, 0.0f}) : 0.0f) {}
    explicit ScalarSlot(float value) : constant_(true), value_(value) {}

    float eval(const TextureCoordinates& uv) const { return constant_ ? value_ : texture_->scalar(uv); }
    bool textured() const { return !constant_; }
    /// Zero everywhere.
    bool zero() const { return constant_ && value_ == 0.0f; }

  private:
    TexturePtr texture_;
    bool constant_;
    float value_;
};

}  // namespace mote::core
