// Factories of the BSDFs, for code that builds scenes itself and for tests. The scene loader reaches the same
// classes through the registry. A null texture stands for 1 (for diffuse_reflectance: 0.5).
#pragma once

#include <memory>

#include "core/materials/bsdf.h"
#include "core/materials/index_of_refraction.h"
#include "core/materials/roughness.h"
#include "core/materials/texture.h"

namespace mote::core {

/// A texture that BSDFs share.
using TexturePtr = std::shared_ptr<const Texture>;
/// A BSDF that others nest.
using BsdfPtr = std::shared_ptr<const Bsdf>;

struct ConductorParameters {
    ComplexIndex index;               ///< of refraction, per channel
    TexturePtr specular_reflectance;  ///< multiplies what is reflected
};
/// Of glass.
struct DielectricParameters {
    float int_ior = 1.5046f, ext_ior = 1.000277f;             ///< below and above the surface (bk7 in air)
    TexturePtr specular_reflectance, specular_transmittance;  ///< multiply what is reflected and let through
};
/// Of a diffuse base under a coat.
struct PlasticParameters {
    float int_ior = 1.49f, ext_ior = 1.000277f;            ///< polypropylene in air
    TexturePtr diffuse_reflectance, specular_reflectance;  ///< of the base, and a factor on the coat
    bool nonlinear = false;                                ///< colour shifts by multiple scattering inside
    bool conserve_energy = false;  ///< rough only: what facets send to each other is not lost
};
/// Of the modified Phong model.
struct PhongParameters {
    float exponent = 30.0f;                                ///< of the cosine around the mirrored direction
    TexturePtr diffuse_reflectance, specular_reflectance;  ///< null: 0.5 and 0.2
};

/// Weights lie in [0, 1]; null textures stand for 0, those of base_color and roughness for 0.5.
struct PrincipledParameters {
    /// As Burley (2012, 2015) calls them.
    TexturePtr base_color, roughness, anisotropic, metallic, spec_trans, spec_tint;
    /// The same.
    TexturePtr sheen, sheen_tint, flatness, clearcoat, clearcoat_gloss;
    float eta = 1.5f;  ///< below the surface over above
    /// How often lobes are drawn, relatively.
    struct Rates {
        float diffuse = 1.0f, specular = 1.0f, clearcoat = 1.0f;  ///< one a lobe
    } rates{};                                                    ///< how often lobes are drawn, relatively
};
/// The same for sheets without an inside.
struct PrincipledThinParameters {
    /// As above.
    TexturePtr base_color, roughness, anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness;
    TexturePtr eta;         ///< null: 1.5
    TexturePtr diff_trans;  ///< 0 to 2
    /// How often lobes are drawn, relatively.
    struct Rates {
        /// One a lobe, reflected and let through.
        float diffuse = 1.0f, diffuse_through = 1.0f, specular = 1.0f, specular_through = 1.0f;
    } rates{};  ///< see Rates
};

/// Lambertian reflection, on the side of the normal.
std::shared_ptr<Bsdf> make_diffuse(TexturePtr reflectance);
std::shared_ptr<Bsdf> make_conductor(const ConductorParameters& parameters);
/// Rough metal.
std::shared_ptr<Bsdf> make_rough_conductor(const ConductorParameters& parameters, const Roughness& roughness);
std::shared_ptr<Bsdf> make_dielectric(const DielectricParameters& parameters);
/// A pane, which does not refract.
std::shared_ptr<Bsdf> make_thin_dielectric(const DielectricParameters& parameters);
/// Throws InputError when the two indices are nearly equal: no normals are refracted then.
std::shared_ptr<Bsdf> make_rough_dielectric(const DielectricParameters& parameters,
                                            const Roughness& roughness);
/// A diffuse base under a smooth coat.
std::shared_ptr<Bsdf> make_plastic(const PlasticParameters& parameters);
/// Isotropic distributions only: alpha_u counts.
std::shared_ptr<Bsdf> make_rough_plastic(const PlasticParameters& parameters, const Microfacet& microfacet);
/// Reflectances that add up to more than 1 are scaled down together.
std::shared_ptr<Bsdf> make_phong(const PhongParameters& parameters);
/// As in Mitsuba, an index of 1 is raised to 1.001 where light is transmitted.
std::shared_ptr<Bsdf> make_principled(const PrincipledParameters& parameters);
/// The same for sheets without an inside.
std::shared_ptr<Bsdf> make_principled_thin(const PrincipledThinParameters& parameters);
std::shared_ptr<Bsdf> make_null();
/// (1 - weight) of the first and weight of the second. A null texture stands for 0.5.
std::shared_ptr<Bsdf> make_blend(BsdfPtr first, BsdfPtr second, TexturePtr weight);
/// 1 - opacity of the light passes straight on, the rest meets `nested`. A null texture stands for 0.5.
std::shared_ptr<Bsdf> make_mask(BsdfPtr nested, TexturePtr opacity);

/// Of normal and bump maps.
struct BentNormalSettings {
    bool flip_invalid_normals = true;    ///< a normal that the viewer sees from behind is turned over
    bool use_shadowing_function = true;  ///< light from near the horizon is faded
};
/// Colours 2 (r, g, b) - 1 are the normal along dp/du, across it, and along the surface's normal.
std::shared_ptr<Bsdf> make_normal_map(BsdfPtr nested, TexturePtr normals,
                                      const BentNormalSettings& settings = {});
/// `heights` times `scale` in metres along the normal.
std::shared_ptr<Bsdf> make_bump_map(BsdfPtr nested, TexturePtr heights, float scale = 1.0f,
                                    const BentNormalSettings& settings = {});
/// `front` scatters on the side of the normal, `back` on the other; a null `back` means the same on both.
/// Throws InputError when one of them transmits light.
std::shared_ptr<Bsdf> make_twosided(BsdfPtr front, BsdfPtr back = nullptr);

class Properties;
/// int_ior, ext_ior, specular_reflectance, specular_transmittance.
DielectricParameters dielectric_parameters(const Properties& properties);
/// int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear.
PlasticParameters plastic_parameters(const Properties& properties);

}  // namespace mote::core
