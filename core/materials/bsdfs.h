// Factories of the BSDFs, for code that builds scenes itself and for tests. The scene loader reaches the same
// classes through the registry.
#pragma once

#include <memory>

#include "core/materials/bsdf.h"
#include "core/materials/index_of_refraction.h"
#include "core/materials/roughness.h"
#include "core/materials/texture_rows.h"

namespace mote::core {

/// A BSDF that others nest.
using BsdfPtr = std::shared_ptr<const Bsdf>;

/// A texture of one grey value.
inline TexturePtr grey_texture(float value) { return make_constant_texture(Rgb(value)); }

struct ConductorParameters {
    ComplexIndex index;                                    ///< of refraction, per channel
    TexturePtr specular_reflectance = grey_texture(1.0f);  ///< multiplies what is reflected
};
/// Glass and the like.
struct DielectricParameters {
    IndexOfRefraction int_ior = "bk7", ext_ior = "air";      ///< below and above the surface
    TexturePtr specular_reflectance = grey_texture(1.0f);    ///< multiplies what is reflected
    TexturePtr specular_transmittance = grey_texture(1.0f);  ///< multiplies what is let through
};
/// A diffuse base under a coat.
struct PlasticParameters {
    IndexOfRefraction int_ior = "polypropylene", ext_ior = "air";  ///< of the coat and above it
    TexturePtr diffuse_reflectance = grey_texture(0.5f);           ///< of the base
    TexturePtr specular_reflectance = grey_texture(1.0f);          ///< factor on the coat's reflection
    bool nonlinear = false;        ///< colour shifts by multiple scattering inside
    bool conserve_energy = false;  ///< rough only: what facets send to each other is not lost
};
/// The modified Phong model.
struct PhongParameters {
    float exponent = 30.0f;                                ///< of the cosine around the mirrored direction
    TexturePtr diffuse_reflectance = grey_texture(0.5f);   ///< of the diffuse part
    TexturePtr specular_reflectance = grey_texture(0.2f);  ///< of the lobe
};

/// Weights that both principled models share, as Burley (2012, 2015) calls them; they lie in [0, 1].
struct PrincipledWeights {
    TexturePtr base_color = grey_texture(0.5f), roughness = grey_texture(0.5f);    ///< of all lobes
    TexturePtr anisotropic = grey_texture(0.0f), spec_trans = grey_texture(0.0f);  ///< of glossy lobes
    TexturePtr spec_tint = grey_texture(0.0f), sheen = grey_texture(0.0f);         ///< tint; cloth
    TexturePtr sheen_tint = grey_texture(0.0f), flatness = grey_texture(0.0f);     ///< of diffuse lobes
};
/// The principled model for solid bodies (Burley 2012).
struct PrincipledParameters : PrincipledWeights {
    TexturePtr metallic = grey_texture(0.0f);         ///< weight of the metal
    TexturePtr clearcoat = grey_texture(0.0f);        ///< weight of a second coating
    TexturePtr clearcoat_gloss = grey_texture(0.0f);  ///< its smoothness
    float eta = 1.5f;                                 ///< below the surface over above
    /// Frequencies at which lobes are sampled, relative to each other.
    struct Rates {
        float diffuse = 1.0f, specular = 1.0f, clearcoat = 1.0f;  ///< one a lobe
    } rates{};                                                    ///< see Rates
};
/// The principled model for sheets without an inside.
struct PrincipledThinParameters : PrincipledWeights {
    TexturePtr eta = grey_texture(1.5f);         ///< index of refraction
    TexturePtr diff_trans = grey_texture(0.0f);  ///< 0 to 2
    /// Frequencies at which lobes are sampled, relative to each other.
    struct Rates {
        /// One a lobe, reflected and let through.
        float diffuse = 1.0f, diffuse_through = 1.0f, specular = 1.0f, specular_through = 1.0f;
    } rates{};  ///< see Rates
};

/// Lambertian reflection, on the side of the normal.
std::shared_ptr<Bsdf> make_diffuse(TexturePtr reflectance = grey_texture(0.5f));
std::shared_ptr<Bsdf> make_conductor(const ConductorParameters& parameters);  ///< smooth metal
/// Rough metal.
std::shared_ptr<Bsdf> make_rough_conductor(const ConductorParameters& parameters, const Roughness& roughness);
std::shared_ptr<Bsdf> make_dielectric(const DielectricParameters& parameters);  ///< smooth glass
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
/// The principled model of a sheet without an inside.
std::shared_ptr<Bsdf> make_principled_thin(const PrincipledThinParameters& parameters);
std::shared_ptr<Bsdf> make_null();
/// (1 - weight) of the first and weight of the second.
std::shared_ptr<Bsdf> make_blend(BsdfPtr first, BsdfPtr second, TexturePtr weight);
/// 1 - opacity of the light passes straight on, the rest meets `nested`.
std::shared_ptr<Bsdf> make_mask(BsdfPtr nested, TexturePtr opacity);

/// Settings of normal and bump maps.
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

/// specular_reflectance.
const ParameterList<ConductorParameters>& conductor_rows();
/// int_ior, ext_ior, specular_reflectance, specular_transmittance.
const ParameterList<DielectricParameters>& dielectric_rows();
/// int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear.
const ParameterList<PlasticParameters>& plastic_rows();

}  // namespace mote::core
