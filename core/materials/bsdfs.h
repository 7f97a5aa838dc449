// Factories of the BSDFs, for code that builds scenes itself and for tests. The scene loader reaches the same
// classes through the registry. A null texture stands for 1 (for diffuse_reflectance: 0.5).
#pragma once

#include <memory>

#include "core/materials/bsdf.h"
#include "core/materials/index_of_refraction.h"
#include "core/materials/microfacet.h"
#include "core/materials/texture.h"

namespace mote::core {

using TexturePtr = std::shared_ptr<const Texture>;
using BsdfPtr = std::shared_ptr<const Bsdf>;

struct ConductorParameters {
    ComplexIndex index;
    TexturePtr specular_reflectance;
};
struct DielectricParameters {
    float int_ior = 1.5046f, ext_ior = 1.000277f;  ///< below and above the surface (bk7 in air)
    TexturePtr specular_reflectance, specular_transmittance;
};
struct PlasticParameters {
    float int_ior = 1.49f, ext_ior = 1.000277f;  ///< polypropylene in air
    TexturePtr diffuse_reflectance, specular_reflectance;
    bool nonlinear = false;  ///< colour shifts by multiple scattering inside
};
struct PhongParameters {
    float exponent = 30.0f;
    TexturePtr diffuse_reflectance, specular_reflectance;  ///< null: 0.5 and 0.2
};

std::shared_ptr<Bsdf> make_diffuse(TexturePtr reflectance);
std::shared_ptr<Bsdf> make_conductor(const ConductorParameters& parameters);
std::shared_ptr<Bsdf> make_rough_conductor(const ConductorParameters& parameters,
                                           const Microfacet& microfacet);
std::shared_ptr<Bsdf> make_dielectric(const DielectricParameters& parameters);
std::shared_ptr<Bsdf> make_thin_dielectric(const DielectricParameters& parameters);
/// Throws InputError when the two indices are nearly equal: no normals are refracted then.
std::shared_ptr<Bsdf> make_rough_dielectric(const DielectricParameters& parameters,
                                            const Microfacet& microfacet);
std::shared_ptr<Bsdf> make_plastic(const PlasticParameters& parameters);
/// Isotropic distributions only: alpha_u counts.
std::shared_ptr<Bsdf> make_rough_plastic(const PlasticParameters& parameters, const Microfacet& microfacet);
/// Reflectances that add up to more than 1 are scaled down together.
std::shared_ptr<Bsdf> make_phong(const PhongParameters& parameters);
std::shared_ptr<Bsdf> make_null();
/// `front` scatters on the side of the normal, `back` on the other; a null `back` means the same on both.
/// Throws InputError when one of them transmits light.
std::shared_ptr<Bsdf> make_twosided(BsdfPtr front, BsdfPtr back = nullptr);

class Properties;
/// int_ior, ext_ior, specular_reflectance, specular_transmittance.
DielectricParameters dielectric_parameters(const Properties& properties);
/// int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear.
PlasticParameters plastic_parameters(const Properties& properties);

}  // namespace mote::core
