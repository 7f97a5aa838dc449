// The interface of lights: sampled from a receiver (direct light), or from the light itself (particles).
#pragma once

#include <optional>

#include "core/math/bounds.h"
#include "core/math/vec.h"
#include "core/objects/error.h"
#include "core/objects/object.h"
#include "core/scene/light_bounds.h"

namespace mote::core {

class Medium;
class Shape;
struct SurfaceHit;

/// Kind of a light; `environment` surrounds the scene.
enum class EmitterKind : std::uint8_t { point, spot, directional, area, environment, medium };

struct EmitterTraits {
    EmitterKind kind = EmitterKind::point;  ///< what it is
    bool delta_position = false;            ///< point-like: cannot be hit
    bool delta_direction = false;           ///< parallel light: cannot be hit
    bool infinite = false;                  ///< surrounds the scene
    bool textured = false;                  ///< its light varies by a picture
    bool direct = true;  ///< false: receivers never choose it; found by their scattering directions alone
    bool can_be_hit() const { return !delta_position && !delta_direction; }  ///< can a ray find it?
};

/// A connection from a reference point to the light.
struct DirectSample {
    Vec3 wi;         ///< unit, from the reference point to the light
    float distance;  ///< to the point on the light; infinity for lights at infinity
    Rgb weight;      ///< L_e (with the light's fall-off) / pdf, without visibility, transmittance and the
                     ///< receiver's cosine
    float pdf_solid_angle;  ///< at the reference point; 0 for delta lights (then weight is the full value);
                            ///< for a point in a medium per solid angle and length [1/(sr m)]
    bool delta = false;     ///< no ray could have found it
    Vec3 normal{0, 0, 0};   ///< of the light's surface; zero where there is none
    /// Density along the ray with which a walk in direction wi finds this point: of emission in a medium,
    /// where it makes a direction's density one per solid angle and length [1/m]; else 1.
    float line_density = 1.0f;
    const Medium* inside =
        nullptr;  ///< the point counts only where this medium is the one at it; null: always
};

/// The start of a light particle.
struct EmissionSample {
    Vec3 origin;     ///< [m]
    Vec3 direction;  ///< unit, away from the light
    Vec3 normal;     ///< of the light's surface at the origin; zero where there is none
    Rgb weight;      ///< L_e * |cos| / (pdf_area * pdf_solid_angle): the power carried by the particle [W]
    float pdf_area;  ///< of the origin; 1 for a delta position. Lights at infinity: over the disk they start
                     ///< from. Media: per volume [1/m^3]
    float pdf_solid_angle;           ///< of the direction; 1 for a delta direction
    const Shape* shape = nullptr;    ///< shape that it leaves, or null
    const Medium* inside = nullptr;  ///< the particle counts only where this medium is the one at its origin
};

/// The two densities of EmissionSample, of a particle that some other technique found.
struct EmissionDensity {
    float pdf_area = 0.0f;         ///< of the origin, in the measure of EmissionSample::pdf_area
    float pdf_solid_angle = 0.0f;  ///< of the direction, given the origin
};

/// A light.
class Emitter : public Object {
  public:
    /// Kind and properties.
    virtual EmitterTraits traits() const = 0;

    /// Called once when the scene is complete: bounding sphere of everything. Lights at infinity need it.
    virtual void set_scene_bounds(const Vec3& /*center*/, float /*radius*/) {}

    /// Samples a direction to the light as seen from p. Nothing when the light is black there.
    virtual std::optional<DirectSample> sample_direct(const Vec3& p, const Vec2& u) const = 0;
    /// Density, per solid angle at p, of sample_direct() choosing the light point that a ray from p hit:
    /// `hit` for area lights, the direction wi alone for lights at infinity (hit is null then).
    virtual float pdf_direct(const Vec3& p, const Vec3& wi, const SurfaceHit* hit) const = 0;

    /// Radiance leaving an area light at `hit` towards wo (world, away from the light). Black behind.
    virtual Rgb radiance(const SurfaceHit& /*hit*/, const Vec3& /*wo*/) const { return Rgb(0.0f); }
    /// Radiance arriving from direction wi (away from the receiver) for lights at infinity.
    virtual Rgb environment(const Vec3& /*wi*/) const { return Rgb(0.0f); }

    /// Samples a particle. Nothing when the sample carries no light.
    virtual std::optional<EmissionSample> sample_emission(const Vec2& u_position,
                                                          const Vec2& u_direction) const = 0;

    /// With which densities sample_emission() samples this origin and this direction (unit, away from the
    /// light). `normal` is that of the light's surface at the origin, and of no consequence for other lights.
    /// Samples that carry no light count like all others.
    ///
    /// A delta part (see EmitterTraits) is taken to be the light's own and counts as 1: no other technique
    /// can find it. For lights at infinity any point of the particle's ray will do for its origin, since all
    /// of them belong to one point of the disk; the density of a vertex there is pdf_area |cos|, without a
    /// distance. A path that leaves the scene in direction w found a particle of direction -w.
    virtual EmissionDensity pdf_emission(const Vec3& origin, const Vec3& normal,
                                         const Vec3& direction) const = 0;

    /// Emitted power [W]; a good estimate is enough: it only steers how often the light is chosen.
    virtual Rgb power() const = 0;

    /// Where the light is and whereto it shines, for a light hierarchy. Nothing for lights without a place:
    /// at infinity, in media.
    virtual std::optional<LightBounds> bounds() const { return std::nullopt; }

    /// Sets the probability of this light in Scene::choose_light(); called once for lights without bounds().
    virtual void set_direct_probability(float /*probability*/) {}

    /// Area lights belong to a shape.
    virtual void set_shape(const Shape* /*shape*/) {}

    const Medium* medium = nullptr;  ///< the medium around the light where the scene file names one
    SourceLocation medium_where;     ///< of that name
    SourceLocation where;            ///< of the light itself
};

}  // namespace mote::core
