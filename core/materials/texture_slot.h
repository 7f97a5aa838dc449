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

    Rgb eval(const TextureCoordinates& uv) const { return constant_ ? value_ : texture_->eval(uv); }
    bool textured() const { return !constant_; }
    Rgb mean() const { return constant_ ? value_ : texture_->mean(); }
    /// Largest channel anywhere.
    float maximum() const { return constant_ ? max_component(value_) : texture_->maximum(); }

  private:
    std::shared_ptr<const Texture> texture_;
    bool constant_;
    Rgb value_;
};

/// The same for one number: Texture::scalar().
class ScalarSlot {
  public:
    /// A null texture stands for the constant `value`.
    explicit ScalarSlot(std::shared_ptr<const Texture> texture, float value = 0.0f)
        : texture_(std::move(texture)),
          constant_(!texture_ || texture_->constant()),
          value_(texture_ && constant_ ? texture_->scalar({0.0f, 0.0f}) : value) {}

    float eval(const TextureCoordinates& uv) const { return constant_ ? value_ : texture_->scalar(uv); }
    bool textured() const { return !constant_; }
    /// Zero everywhere.
    bool zero() const { return constant_ && value_ == 0.0f; }

  private:
    std::shared_ptr<const Texture> texture_;
    bool constant_;
    float value_;
};

}  // namespace mote::core
