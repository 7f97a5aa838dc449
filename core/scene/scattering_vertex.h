// A vertex of a path where light scatters: a point on a surface or in a medium, behind one face.
//
// f* is the BSDF on a surface and the phase function in a medium (Engelhardt 2013, Sec. 10.1); the
// coefficient sigma_s of a medium is carried by the distance sampling that made the vertex, so it does not
// appear here.
#pragma once

#include <optional>

#include "core/geometry/bsdf_point.h"
#include "core/math/sampler.h"
#include "core/scene/light_bounds.h"
#include "core/scene/medium_state.h"
#include "core/scene/ray_walk.h"

namespace mote::core {

/// A direction sampled at a vertex.
struct ScatterSample {
    Vec3 wi;                                  ///< world
    Rgb weight;                               ///< f* C* / pdf
    float pdf_solid_angle;                    ///< 0 for a delta part
    float eta = 1.0f;                         ///< relative index of refraction along the path
    bool delta = false, transmitted = false;  ///< of a delta part; to the other side of the surface
};

/// Scattering function of a vertex for two directions.
struct ScatteringValue {
    Rgb f_cos;              ///< f* C*
    float pdf_solid_angle;  ///< of ScatteringVertex::sample()
};

/// A point where a path scatters.
struct ScatteringVertex {
    Vec3 position;                         ///< [m]
    Vec3 wo;                               ///< unit, away from the vertex, towards where the path came from
    const Bsdf* bsdf = nullptr;            ///< surface
    const PhaseFunction* phase = nullptr;  ///< medium
    SurfaceHit hit;                        ///< surface only
    /// For a pane that stopped the path here by chance (StraightPassage::stops); 1 on all other surfaces.
    /// What passes the pane is no part of what the vertex scatters, and the rest counts by this chance.
    float stop_chance = 1.0f;

    bool on_surface() const { return bsdf != nullptr; }             ///< or in a medium
    BsdfPoint bsdf_point() const { return core::bsdf_point(hit); }  ///< where on the surface

    /// f*(wo, wi) [1/sr], without cosine. Zero where shading and geometric normal disagree on the side, so
    /// that no light leaks through smooth-shaded surfaces. `peak_limit`: BsdfPoint::peak_limit.
    Rgb eval(const Vec3& wi, TransportMode mode, float peak_limit = infinity) const;
    /// f*(wo, wi) times the shading cosine of wi (1 in a medium).
    Rgb eval_cos(const Vec3& wi, TransportMode mode, float peak_limit = infinity) const;
    /// eval_cos() and pdf_solid_angle(); the density is of no use where the value is black.
    ScatteringValue eval_cos_and_pdf(const Vec3& wi, TransportMode mode) const;
    /// Density of sample() choosing wi, per solid angle.
    float pdf_solid_angle(const Vec3& wi, TransportMode mode) const;
    /// Samples a direction; nothing where the path ends.
    std::optional<ScatterSample> sample(float u_lobe, const Vec2& u, TransportMode mode) const;

    /// On a surface: its reflectance where it is Lambertian and nothing else, seen from wo's side.
    std::optional<Rgb> diffuse_reflectance() const;

    /// Has a part that can be connected to a light.
    bool connectable() const { return phase || bsdf->traits().smooth; }
    /// For the choice of a light to connect to.
    LightReceiver light_receiver() const {
        if (!on_surface() || bsdf->traits().transmissive) return {position};
        const Vec3& n = hit.geometric_normal;
        return {position, glm::dot(n, wo) < 0.0f ? -n : n};
    }
    /// Origin for a ray that leaves in `direction`.
    Vec3 ray_origin(const Vec3& direction) const {
        return on_surface() ? offset_origin(hit, direction) : position;
    }
    /// Media on the side that `direction` leaves to, given those on the side of wo.
    MediumState state_towards(const MediumState& state, const Vec3& direction) const;
    /// C*(this -> direction) with the shading normal (the receiver's end of a connection); 1 in a medium.
    float shading_cosine(const Vec3& direction) const {
        return on_surface() ? std::fabs(glm::dot(hit.shading.n, direction)) : 1.0f;
    }
    /// C*(this -> direction) with the geometric normal (the light's end of a connection); 1 in a medium.
    float geometric_cosine(const Vec3& direction) const {
        return on_surface() ? std::fabs(glm::dot(hit.geometric_normal, direction)) : 1.0f;
    }
};

/// The vertex at the end of a walk along `direction`. Precondition: the event is a surface or a collision.
ScatteringVertex make_vertex(const WalkEvent& event, const Ray& ray);

/// Light traced from the light through a vertex with a shading normal needs the factor
/// |wi.ns| |wo.ng| / (|wi.ng| |wo.ns|), where wi is towards the light (Veach 1997, Eq. 5.19). 1 in a medium.
float adjoint_correction(const ScatteringVertex& vertex, const Vec3& towards_light, const Vec3& away);

}  // namespace mote::core
