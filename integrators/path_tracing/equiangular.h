// Equi-angular sampling: light of point and spot lights scattered along a ray.
//
// Distances along the ray are sampled so that directions seen from the light are spread evenly, which cancels
// the 1/d^2 of the light (Kulla & Fajardo 2012):
//   p(t) = D / ((theta_b - theta_a) (D^2 + t^2)),   t = D tan(lerp(theta_a, theta_b, u))
// with t counted from the point of the ray nearest to the light, D away from it. Collisions in thin media
// rarely fall near the light; these always do.
//
// What is left is 1/D: rays that chance sends past a lamp at the distance D are as frequent as D, so its
// square has no finite mean. A vertex before such a ray therefore has a second technique, directions around
// the lamp with a density of 1/sin of the angle to it (joint importance sampling: Georgiev et al. 2013),
// which cancels that as well. A path takes one such direction at every vertex, beside the one in which it
// continues, and the balance heuristic combines the light along both.
#pragma once

#include <memory>
#include <vector>

#include "core/scene/light_tree.h"
#include "core/scene/scattering_vertex.h"
#include "core/scene/scene.h"
#include "lights/emitters/light_cone.h"

namespace mote::integrators {

/// A distance along a ray, sampled equi-angularly around a point.
struct EquiangularSample {
    float t;
    float pdf_distance;  ///< [1/m]
};
/// From [ray.t_min, t_max], which may be infinite. Nothing when the interval is empty.
std::optional<EquiangularSample> sample_equiangular(const core::Ray& ray, float t_max,
                                                    const core::Vec3& light, float u);

/// True where a point or spot light stands in a medium that scatters: light at collisions close to it has no
/// finite variance, since their density does not follow 1/d^2.
bool has_lamps_in_media(const core::Scene& scene);

/// A ray to be lit, and what is known of it.
struct LitRay {
    const core::Ray& ray;
    float t_max;                     ///< of the first surface on it
    const core::MediumState& state;  ///< media at ray.t_min
    /// Density by which a path chose the direction [1/sr]; infinity: nothing else could have, such as a
    /// camera or a mirror.
    float pdf_solid_angle = core::infinity;
};

/// The point and spot lights of a scene. One is sampled for the ray by a hierarchy; a spot's samples lie
/// inside its cone.
class EquiangularLights {
  public:
    explicit EquiangularLights(const core::Scene& scene);
    bool empty() const { return lights_.empty(); }

    /// Unbiased estimate of the light that reaches ray.t_min after one scattering between there and t_max,
    /// weighted against scattered_around_lamps(). `context.boundary_hits`: the boundaries on the ray.
    core::Rgb scattered_along(const core::Scene& scene, const LitRay& lit, const core::Vec2& u,
                              core::WalkContext& context) const;

    /// Unbiased estimate of the light that a vertex scatters after one scattering in media, by directions
    /// around lamps, weighted against those of the path: value(wi) is what the vertex scatters from there,
    /// f* C*, with the density of its own choice. `state`: media at the vertex, on the side of wo.
    template <typename Value>
    core::Rgb scattered_around_lamps(const core::Scene& scene, const core::ScatteringVertex& vertex,
                                     const core::MediumState& state, const Value& value,
                                     core::WalkContext& context) const {
        const auto direction = direction_around_lamp(vertex, context.rng);
        if (!direction) return core::Rgb(0.0f);
        const core::ScatteringValue f = value(direction->wi);
        if (core::is_black(f.f_cos)) return core::Rgb(0.0f);
        return f.f_cos * lit_around(scene, vertex, state, *direction, f.pdf_solid_angle, context);
    }

  private:
    struct Light {
        const core::Emitter* emitter;
        core::Vec3 position;
        std::optional<lights::LightCone> cone;  ///< nothing: shines everywhere
    };
    struct DirectionAroundLamp {
        std::uint32_t light;
        core::Vec3 wi;
    };
    std::optional<DirectionAroundLamp> direction_around_lamp(const core::ScatteringVertex& vertex,
                                                             core::Rng& rng) const;
    core::Rgb lit_around(const core::Scene& scene, const core::ScatteringVertex& vertex,
                         const core::MediumState& state, const DirectionAroundLamp& direction,
                         float pdf_of_path, core::WalkContext& context) const;
    core::Rgb scattered_from(const core::Scene& scene, const Light& light, const LitRay& lit, float u,
                             core::WalkContext& context) const;
    float density_around(const core::Ray& ray, std::uint32_t light) const;

    std::vector<Light> lights_;
    core::LightTree choice_;  ///< for rays
    core::LightTree around_;  ///< for vertices, of lights that shine everywhere
};

}  // namespace mote::integrators
