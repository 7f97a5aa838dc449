// Virtual spherical lights (Hasan et al. 2009): VPLs whose light is spread over a sphere.
//
// The power that arrived at y_j is spread over the disc that a sphere of radius r_j cuts out of the surface:
// every point in the sphere represents y_j, with its BSDF and its normal. A receiver integrates over the cone
// of directions that the sphere subtends (all directions, from inside), instead of evaluating one point:
//
//   L_j = alpha_j / (pi r_j^2)  int_cone  f(x, wo, w) |cos_x|  f(y_j, w_j, -w) |cos_y|  dw
//
// The factor |cos_y| is the fraction of the cone that a plane disc covers. As r -> 0 the cone's solid angle
// is pi r^2 / d^2 and the VPL's f G f alpha is left; near y_j, where that has no bound, L_j has. It is
// biased: light is blurred over the spheres, also around edges and corners that lie within one.
//
// Estimate: n_c directions uniform in the cone, n_x from the BSDF at x, n_y from the BSDF at y_j, combined by
// the balance heuristic. With F the integrand (0 outside the cone, Omega its solid angle), the sum over all
// samples of
//   F / (pi r^2) / (n_c / Omega + n_x p_x + n_y p_y)  =  F (Omega / (pi r^2)) / (n_c + Omega (n_x p_x + n_y
//   p_y))
// has the mean L_j, and the form on the right needs no division by r: it is exactly the VPL's at r = 0.
#pragma once

#include <vector>

#include "compensation/sphere_cone.h"
#include "lights/virtual_lights/virtual_point_light.h"

namespace mote::compensation {

struct SphericalLight {
    const lights::VirtualPointLight& vpl;  ///< that it represents
    const lights::VplDetail* detail;       ///< null where the VPL is one colour
    float radius;                          ///< [m]

    /// Keeps references into the set; `r` is its radius [m].
    SphericalLight(const lights::VplSet& set, std::size_t index, float r)
        : vpl(set.lights[index]),
          detail(vpl.detail == lights::VirtualPointLight::no_detail ? nullptr : &set.details[vpl.detail]),
          radius(r) {}

    /// Centre of the sphere, on the surface [m].
    core::Vec3 centre() const { return detail ? detail->vertex.position : vpl.position; }
    /// alpha_j f(y_j, w_j, -w) |cos_y| for a receiver that sees the light in direction w.
    core::Rgb intensity_cos(const core::Vec3& w) const;
    /// Density of -w when the VPL's BSDF samples the next direction; 0 without detail.
    float pdf_solid_angle(const core::Vec3& w) const;
};

/// Radius of every light [m]: `scale` times the distance to its `neighbours`-th nearest other VPL (Hasan et
/// al. 2009: the 10th), or to the farthest where there are fewer; 0 for a light that is alone.
/// Precondition: all VPLs lie on surfaces.
std::vector<float> sphere_radii(const lights::VplSet& set, std::uint32_t neighbours, float scale);

/// Samples of each technique for one light. A diffuse BSDF has no technique of its own.
struct SampleCounts {
    /// By the sphere's solid angle, by the BSDF of the receiver, by that of the light.
    int cone, receiver, light;
    /// Shares them out among the techniques that have something to sample.
    SampleCounts(int samples, bool glossy_receiver, bool glossy_light);
};

/// L_j at `receiver` as if nothing stood between, estimated with `samples` >= 1 directions.
core::Rgb unoccluded_light(const core::ScatteringVertex& receiver, const SphericalLight& light, int samples,
                           core::Rng& rng);

/// Segments that shadow rays test.
enum class SphereVisibility : std::uint8_t {
    /// One ray per sampled direction, until it enters the sphere or reaches the tangent plane of y_j: behind
    /// either lies the light's own surface. Without the plane the surface in front of the sphere would hide
    /// part of its own light, a fraction that does not vanish with r. From inside there is no such segment,
    /// and
    /// the centre is tested.
    per_sample,
    /// One ray to the centre for all directions, as in the paper: shadow edges as hard as a VPL's.
    per_light
};

/// Settings of the gather of spheres.
struct SphericalGather {
    std::uint32_t neighbours = 10;  ///< the distance of the farthest of them is the radius
    float radius_scale = 1.0f;      ///< multiplies it
    int samples = 4;                ///< a light
    SphereVisibility visibility = SphereVisibility::per_sample;  ///< where shadow rays go
};

/// The light of all spheres at `receiver`, a vertex on a surface of a scene without media. VPLs deeper than
/// `max_vpl_depth` are left out. Counts shadow rays.
core::Rgb gather_spheres(const core::RayQueries& scene, const lights::VplSet& set,
                         const std::vector<float>& radii, const SphericalGather& settings,
                         const core::ScatteringVertex& receiver, std::int32_t max_vpl_depth, core::Rng& rng,
                         core::RayCounters& rays);

}  // namespace mote::compensation
