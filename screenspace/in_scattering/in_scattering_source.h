// Interface through which screen-space sampling evaluates the light scattered into eye rays.
//
// Film positions are in pixels. The sampling methods (screenspace/epipolar) are independent of scenes: tests
// implement the interface by functions, in_scattering_rays.h by rays.
#pragma once

#include <memory>

#include "core/math/ray.h"

namespace mote::screenspace {

using Vec2d = glm::dvec2;

/// The end of the lit part of an eye ray.
struct RayEnd {
    float distance =
        0.0f;  ///< along the ray [m]: to the surface, or to where the ray leaves the light's cone and the
               ///< media before it gets there; 0 where no light can be scattered into the ray
    bool surface = false;  ///< it ends at the surface
    /// Integral of 1/d^2 over the lit part [1/m]. Light over weight is interpolated, because it depends
    /// neither on how close the light is nor on the length of the ray.
    float weight = 1.0f;
    core::Vec3 position{0.0f}, normal{0.0f};  ///< of that surface; normal: geometric, unit, either side
    bool dark() const { return !(distance > 0.0f); }  ///< no light can be scattered into the ray
};

/// One ray marched to its end.
struct MarchedRay {
    core::Rgb radiance{0.0f};       ///< scattered into the ray [W/(m^2 sr)]
    core::Rgb transmittance{1.0f};  ///< of the media, up to the end
};

/// Work of one thread.
class InScatteringTask {
  public:
    virtual ~InScatteringTask() = default;
    /// Through a place of the film.
    virtual core::Ray ray(const Vec2d& film) = 0;
    virtual RayEnd end_of(const Vec2d& film) = 0;
    virtual MarchedRay march(const Vec2d& film,
                             const RayEnd& end) = 0;  ///< the costly part, to be done for few rays
};

/// Gives each thread its task.
class InScatteringSource {
  public:
    virtual ~InScatteringSource() = default;
    /// For one thread; called from any.
    virtual std::unique_ptr<InScatteringTask> start() const = 0;
};

/// True if two rays end at one surface, or both beyond all light: then light is interpolated between them.
/// The second ends at `distance`; `ray()` returns it where it is needed. Surfaces continue where distances
/// differ by less than the fraction `tolerance`, or where the second ray meets the first end's tangent plane
/// as closely to its own end as that: floors seen at a flat angle.
template <typename RayOf>
bool continues(const RayEnd& end, float distance, bool surface, float tolerance, const RayOf& ray) {
    if (end.dark() || !(distance > 0.0f)) return false;
    if (!end.surface && !surface) return true;
    const float allowed = tolerance * std::fmin(end.distance, distance);
    if (std::fabs(distance - end.distance) <= allowed) return true;
    if (!end.surface || !surface) return false;
    const core::Ray other = ray();
    const float on_plane =
        glm::dot(end.normal, end.position - other.origin) / glm::dot(end.normal, other.direction);
    return std::fabs(on_plane - distance) <= allowed;
}

}  // namespace mote::screenspace
