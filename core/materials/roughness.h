// The microfacets of a surface whose roughness may be textured.
#pragma once

#include "core/materials/microfacet.h"
#include "core/materials/texture_rows.h"
#include "core/materials/texture_slot.h"

namespace mote::core {

class Roughness {
  public:
    /// One roughness everywhere; meant to be implicit.
    Roughness(const Microfacet& everywhere)
        : everywhere_(everywhere),
          alpha_u_(everywhere.alpha_u()),
          alpha_v_(everywhere.alpha_v()),
          textured_(false) {}
    /// One texture for both directions is isotropic.
    Roughness(MicrofacetKind kind, const TexturePtr& alpha_u, const TexturePtr& alpha_v)
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

/// The parameters of a rough BSDF.
struct RoughnessSettings {
    MicrofacetKind distribution = MicrofacetKind::beckmann;  ///< of the facets' normals
    TexturePtr alpha = make_constant_texture(Rgb(0.1f));     ///< root mean square slope
    TexturePtr alpha_u, alpha_v;                             ///< along the tangent and across it, or null
};
/// distribution, alpha, alpha_u and alpha_v.
const ParameterList<RoughnessSettings>& roughness_rows();
/// Throws InputError where alpha contradicts alpha_u and alpha_v; warns of surfaces that are too smooth.
Roughness roughness_of(const RoughnessSettings& settings, const Properties& properties);

/// The parameters of a rough BSDF whose roughness is one number.
struct MicrofacetSettings {
    MicrofacetKind distribution = MicrofacetKind::beckmann;  ///< of the facets' normals
    float alpha = 0.1f;                                      ///< root mean square slope
};
/// distribution and alpha.
const ParameterList<MicrofacetSettings>& microfacet_rows();
/// Warns of surfaces that are too smooth.
Microfacet microfacet_of(const MicrofacetSettings& settings, const Properties& properties);

}  // namespace mote::core
