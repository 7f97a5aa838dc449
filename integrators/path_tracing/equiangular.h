// Equi-angular sampling: light of point and spot lights scattered along a ray.
//
// Distances along the ray are sampled so that directions seen from the light are spread evenly, which cancels
// the 1/d^2 of the light (Kulla & Fajardo 2012):
//   p(t) = D / ((theta_b - theta_a) (D^2 + t^2)),   t = D tan(lerp(theta_a, theta_b, u))
// with t counted from the point of the ray nearest to the light, D away from it. Collisions in thin media
// rarely fall near the light; these always do.
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

/// The point and spot lights of a scene. One is sampled for the ray by a hierarchy; a spot's samples lie
/// inside its cone.
class EquiangularLights {
  public:
    explicit EquiangularLights(const core::Scene& scene);
    bool empty() const { return lights_.empty(); }

    /// Unbiased estimate of the light that reaches ray.t_min after one scattering between there and t_max,
    /// the first surface on the ray. `state` holds the media at ray.t_min; `boundaries` those on the ray.
    core::Rgb scattered_along(const core::Scene& scene, const core::Ray& ray, float t_max,
                              const core::MediumState& state, const core::Vec2& u,
                              core::WalkContext& context) const;

  private:
    struct Light {
        const core::Emitter* emitter;
        core::Vec3 position;
        std::optional<lights::LightCone> cone;  ///< nothing: shines everywhere
    };
    std::vector<Light> lights_;
    core::LightTree choice_;
};

}  // namespace mote::integrators
