// The interface of surface scattering.
//
// Directions are unit vectors in the local shading frame (z is the shading normal) and point away from the
// surface: wo to the viewer, wi to the light. `eval` never holds the cosine.
#pragma once

#include <optional>

#include "core/materials/texture_coordinates.h"
#include "core/math/direction_cone.h"
#include "core/math/vec.h"
#include "core/objects/object.h"

namespace mote::core {

/// Quantity that travels along the path: radiance from the eye, or power (importance's adjoint) from a
/// light. Matters where light crosses a refractive boundary: radiance is scaled by (eta_i/eta_o)^2, power is
/// not.
enum class TransportMode : std::uint8_t { radiance, power };

/// The mode of the same path traced from its other end.
inline TransportMode opposite(TransportMode mode) {
    return mode == TransportMode::radiance ? TransportMode::power : TransportMode::radiance;
}

struct BsdfTraits {
    bool smooth = false;        ///< has a part that eval() sees (non-delta)
    bool delta = false;         ///< has a part that only sample() can produce
    bool transmissive = false;  ///< lets light through
    bool null = false;         ///< the surface is invisible: light passes straight (a boundary between media)
    bool pane = false;         ///< a part of the light passes straight on: see straight_passage()
    bool tints = false;        ///< a pane, and what passes it straight on changes its colour
    bool diffuse = false;      ///< exactly Lambertian reflection: diffuse_reflectance() says all
    bool textured = false;     ///< varies with the texture coordinates
    bool anisotropic = false;  ///< looks different when turned about the normal

    /// Light goes straight on, all of it or a part: such a surface stops no connection.
    bool passes_straight() const { return null || pane; }
};

/// A direction sampled for a viewer.
struct BsdfSample {
    Vec3 wi;                   ///< local
    Rgb weight;                ///< f * |cos(wi)| / pdf; for a delta part, the weight of that part
    float pdf_solid_angle;     ///< density of wi over the smooth part; 0 for a delta part
    bool delta = false;        ///< of a part that only sample() produces
    bool transmitted = false;  ///< wi lies on the other side of the surface
    float eta = 1.0f;          ///< relative index of refraction along the path (for Russian roulette)
};

/// Light that passes a pane straight on, unbent: connections pass it, and it counts as no scattering.
struct StraightPassage {
    float stops = 1.0f;  ///< probability that sample() scatters a path: where u_lobe is below this
    Rgb weight{0.0f};    ///< of a path that was let pass
    float probability() const { return 1.0f - stops; }            ///< that a path passes
    Rgb transmittance() const { return probability() * weight; }  ///< of a connection
};

/// Where on the surface: textures are looked up here.
struct BsdfPoint {
    TextureCoordinates uv;  ///< where textures are looked up
    // In the local frame, for BSDFs that bend it; zero where they are not known, and nothing is bent then.
    Vec3 dp_du{0.0f}, dp_dv{0.0f};  ///< derivatives of the position by the texture coordinates [m]
    Vec3 geometric_normal{0.0f, 0.0f, 1.0f};
    /// eval() widens a lobe whose peak, times the cosine of wi, would be higher than this [1/sr]: for light
    /// that is known at a few directions only (compensation/roughness_clamping.h). Sampling does not depend
    /// on it.
    float peak_limit = infinity;
};

/// A BSDF and its density in one pair of directions.
struct BsdfValue {
    Rgb value;              ///< eval() [1/sr]
    float pdf_solid_angle;  ///< pdf_solid_angle() [1/sr]
};

/// Scattering of light by a surface; see the top of this file for directions.
class Bsdf : public Object {
  public:
    /// Parts of the BSDF.
    virtual BsdfTraits traits() const = 0;

    /// Smooth part of the BSDF [1/sr], without cosine. Zero for delta parts.
    virtual Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const = 0;

    /// At least eval() of any wi in a (local) cone, whatever the mode, without a peak_limit [1/sr]: for
    /// upper bounds of what a cluster of lights sends. Infinity: no bound.
    virtual Rgb eval_bound(const BsdfPoint&, const Vec3& /*wo*/, const DirectionCone& /*wi*/) const {
        return Rgb(infinity);
    }

    /// Density of sample() choosing wi given wo, per solid angle, over the smooth part, and including the
    /// chance of choosing the smooth part at all.
    ///
    /// The reverse density, with which a path that goes the other way is scattered from wi to wo, is this one
    /// with the directions exchanged and the other mode: pdf_solid_angle(p, wi, wo, opposite(mode)). Nothing
    /// in the arguments distinguishes the two ways, because both directions point away from the surface and
    /// the local frame stays where it is; indices of refraction are taken from the side that wo is on.
    virtual float pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                                  TransportMode mode) const = 0;

    /// eval() and pdf_solid_angle() at once, for BSDFs that share work between them.
    virtual BsdfValue eval_and_pdf(const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                                   TransportMode mode) const {
        return {eval(p, wo, wi, mode), pdf_solid_angle(p, wo, wi, mode)};
    }

    /// Samples wi given wo. `u_lobe` chooses among lobes, `u` the direction. Nothing when absorbed.
    virtual std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                             TransportMode mode) const = 0;

    /// Passage through a pane from wo's side, equal from both. What eval() and pdf_solid_angle() say holds
    /// for the whole pane; a path that it stopped by chance has both divided by StraightPassage::stops.
    virtual StraightPassage straight_passage(const BsdfPoint&, const Vec3& /*wo*/) const { return {}; }

    /// Reflectance of a purely Lambertian BSDF seen from wo's side; nothing when it is anything else. What a
    /// pane lets pass straight on does not count.
    virtual std::optional<Rgb> diffuse_reflectance(const BsdfPoint&, const Vec3& /*wo*/) const {
        return std::nullopt;
    }
    /// Estimate of the albedo for auxiliary channels and Russian roulette.
    virtual Rgb albedo(const BsdfPoint& p, const Vec3& wo) const = 0;
};

}  // namespace mote::core
