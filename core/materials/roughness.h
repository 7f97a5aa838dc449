// The microfacets of a surface whose roughness may be textured.
#pragma once

#include "core/materials/microfacet.h"
#include "core/materials/texture_slot.h"

namespace mote::core {

class Roughness {
  public:
    /// The same everywhere; meant to be implicit.
    Roughness(const Microfacet& everywhere)
        : everywhere_(everywhere), alpha_u_(nullptr), alpha_v_(nullptr), textured_(false) {}
    /// One texture for both directions is isotropic.
    Roughness(MicrofacetKind kind, const std::shared_ptr<const Texture>& alpha_u,
              const std::shared_ptr<const Texture>& alpha_v)
        : everywhere_(kind, ScalarSlot(alpha_u).eval({}), ScalarSlot(alpha_v).eval({})),
          alpha_u_(alpha_u),
          alpha_v_(alpha_v),
          textured_(alpha_u_.textured() || alpha_v_.textured()),
          anisotropic_(textured_ && alpha_u != alpha_v) {}

    Microfacet at(const TextureCoordinates& uv) const {
        return textured_ ? Microfacet(everywhere_.kind(), alpha_u_.eval(uv), alpha_v_.eval(uv)) : everywhere_;
    }
    bool textured() const { return textured_; }
    bool anisotropic() const { return anisotropic_ || everywhere_.alpha_u() != everywhere_.alpha_v(); }

  private:
    Microfacet everywhere_;
    ScalarSlot alpha_u_, alpha_v_;
    bool textured_, anisotropic_ = false;
};

class Properties;
/// Reads distribution, and alpha or alpha_u and alpha_v, each a number or a texture. Throws InputError when
/// they contradict each other.
Roughness roughness_parameters(const Properties& properties);

}  // namespace mote::core
