// Light of one point-like light that is scattered once into an eye ray: ray marching.
//
//   L = int T(eye, x) sigma_s(x) f_p(x) T(x, light) V(x, light) I / |x - light|^2 dt
// over the part of the ray inside the light's cone and the media. Steps of equal length (Engelhardt 2013,
// chapter 9), or equal angles as seen from the light, which cancel 1/d^2 (Kulla & Fajardo 2012). One offset
// moves all steps together: pictures of one pass are smooth, and over offsets evenly spread in [0, 1) the
// mean is exact for either rule. Transmittances are deterministic: in closed form, or by marching through
// grids.
//
// Two things can stand in for that. In homogeneous media the integral is taken exactly, and where nothing
// is in the way without any shadow ray (in_scattering_exact.cpp). A volumetric shadow map of the light can
// answer instead of shadow rays and of marching towards the light.
#pragma once

#include <vector>

#include "core/scene/medium_state.h"
#include "core/scene/ray_walk.h"
#include "lights/emitters/light_cone.h"
#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "screenspace/in_scattering/analytic_light.h"
#include "screenspace/in_scattering/in_scattering_source.h"
#include "screenspace/in_scattering/unoccluded_space.h"

namespace mote::core {
class Scene;
}

namespace mote::screenspace {

/// Steps of equal angles as seen from the light, or of equal length.
enum class MarchRule : std::uint8_t { equiangular, uniform };

struct MarchSettings {
    int steps = 64;                           ///< a ray
    MarchRule rule = MarchRule::equiangular;  ///< how steps are spread
    float offset = 0.5f;                      ///< of all steps, in [0, 1)
    float voxels = 1.0f;                      ///< step of optical depths through grids, in voxels
};

/// Replacements for steps and shadow rays. Not owned.
struct MarchAccelerations {
    const UnoccludedSpace* space = nullptr;            ///< null: all is marched
    const lights::VolumetricShadowMap* map = nullptr;  ///< of this light; null: shadow rays
};

/// Steps along a part of a ray.
struct StepRule {
    MarchRule rule;      ///< how steps are spread
    PassingRay passing;  ///< how the ray passes the light
    double t0, t1;       ///< ends of the part [m]
    double a0, a1;       ///< as seen from the light [radians]

    /// For the part of a ray from `from` to `to` [m].
    StepRule(MarchRule r, const core::Ray& ray, const core::Vec3& light, double from, double to)
        : rule(r), passing(ray, light), t0(from), t1(to), a0(passing.angle(from)), a1(passing.angle(to)) {}
    /// Where the march has come to after a fraction of its steps.
    double at(double fraction) const;
    /// One over the density of steps at t, per length and for a single step.
    double length(double t) const;
};

/// The part of a ray in one medium, and the media there.
struct MediumSegment {
    const core::Medium* medium;  ///< null: vacuum
    float t0, t1;                ///< its ends [m]
    core::MediumState state;     ///< media in it
    core::Rgb panes{1.0f};       ///< transmittance of the panes right before it
};

/// Generator, counters and memory of one thread.
struct MarchScratch {
    core::WalkContext walk;                     ///< generator and counters
    std::vector<MediumSegment> eye, shadow;     ///< parts of the eye ray, and of the way to the light
    std::vector<float> distances;               ///< of the steps, ascending [m]
    std::vector<char> lit;                      ///< steps that the light reaches
    std::vector<core::ShadowPacket> packets;    ///< from steps to the light
    std::vector<lights::ShadowLookup> lookups;  ///< of steps in a map
    std::uint64_t rays = 0, steps = 0;          ///< so far
    std::uint64_t unoccluded = 0;               ///< rays that needed no step, because nothing was in the way
};

/// Cuts ray.t_min to ray.t_max at the boundaries between media and at panes; `state` holds those at t_min.
/// Neighbours of the same medium without a pane between them are one segment.
void find_segments(const core::RayQueries& scene, const core::Ray& ray, const core::MediumState& state,
                   std::vector<MediumSegment>& segments, core::WalkContext& walk);

/// Transmittance through one medium: deterministic, but for media that have neither a closed form nor
/// marching.
core::Rgb marched_transmittance(const core::Medium& medium, const core::Ray& ray, float voxels,
                                core::WalkContext& walk);
/// Through all segments and panes, up to ray.t_max.
core::Rgb marched_transmittance(const core::Ray& ray, const std::vector<MediumSegment>& segments,
                                float voxels, core::WalkContext& walk);
/// Transmittance of the media alone, for paths that passed the panes by chance.
core::Rgb transmittance_of_media(const core::Ray& ray, const std::vector<MediumSegment>& segments,
                                 float voxels, core::WalkContext& walk);

/// One light's march along any ray.
class InScattering {
  public:
    /// `scattering` holds every point where a medium scatters light [m] (scattering_extent()). The light must
    /// have a position (LitScene::light_position), else std::invalid_argument is thrown. Keeps references to
    /// scene and light.
    InScattering(const core::RayQueries& scene, const core::Bounds3& scattering, const core::Emitter& light,
                 const MarchSettings& settings, const MarchAccelerations& accelerations = {});
    /// In-scattering over scattering_extent(scene).
    InScattering(const core::Scene& scene, const core::Emitter& light, const MarchSettings& settings,
                 const MarchAccelerations& accelerations = {});

    const core::Vec3& light_position() const { return position_; }  ///< [m]
    /// The part of the ray that the light can reach and where there are media: box and cone, no visibility.
    std::optional<core::Interval> lit_part(const core::Ray& ray) const;
    /// The integral of 1/d^2 over a part of the ray, where d is the distance from the light [1/m].
    double unshadowed(const core::Ray& ray, double t0, double t1) const;
    /// The light that reaches ray.t_min from points up to ray.t_max, where the first surface is. `state`
    /// holds the media at ray.t_min.
    MarchedRay march(const core::Ray& ray, const core::MediumState& state, MarchScratch& scratch) const;

  private:
    std::optional<core::Rgb> integrate(const core::Ray& ray, double t0, double t1, const MediumSegment& at,
                                       MarchScratch& scratch) const;
    const AnalyticMedium* analytic_medium(const core::Medium* medium) const;
    template <bool surfaces>
    bool is_free(const core::Ray& ray, double t0, double t1) const;
    void trace_steps(const core::Ray& ray, const StepRule& rule, MarchScratch& scratch) const;
    core::Rgb end_piece(const core::Ray& ray, double t0, double t1, const MediumSegment& at,
                        const AnalyticMedium& medium, MarchScratch& scratch) const;
    void march_steps(const core::Ray& ray, double t0, double t1, MarchScratch& scratch,
                     MarchedRay& result) const;
    core::Rgb eye_transmittance(const core::Ray& ray, float to, MarchScratch& scratch) const;
    void look_up_steps(const core::Ray& ray, MarchScratch& scratch) const;
    void place_steps(const StepRule& rule, std::vector<float>& distances) const;
    core::Rgb scattered_at(const core::Ray& ray, float t, const MediumSegment& at, MarchScratch& scratch,
                           const core::Rgb* from_map = nullptr) const;

    const core::RayQueries& scene_;
    const core::Emitter& light_;
    MarchSettings settings_;
    MarchAccelerations accelerations_;
    core::Vec3 position_;
    std::optional<lights::LightCone> cone_;
    core::Bounds3 media_;  ///< where anything scatters
    std::optional<AnalyticLight> analytic_light_;
    std::vector<AnalyticMedium> analytic_media_;
};

}  // namespace mote::screenspace
