// Rays through a scene that several lights share: what epipolar_crossings.h asks for.
//
// Shared are the first surface, the media along the ray and their transmittance. Every light keeps its steps
// and its shadow rays.
#pragma once

#include <mutex>

#include "screenspace/epipolar/epipolar_crossings.h"
#include "screenspace/in_scattering/eye_view.h"
#include "screenspace/in_scattering/in_scattering.h"

namespace mote::screenspace {

/// Keeps references to scene and lights. All rays pass the point `u_lens` of the lens; grids are walked in
/// steps of `voxels`.
class SharedEyeRays final : public SharedRaySource {
  public:
    SharedEyeRays(const core::RayQueries& scene, EyeView eye, std::span<const InScattering* const> lights,
                  float voxels, const core::Vec2& u_lens)
        : scene_(scene), eye_(std::move(eye)), lights_(lights), voxels_(voxels), u_lens_(u_lens) {}
    /// Through the scene's own camera.
    SharedEyeRays(const core::Scene& scene, std::span<const InScattering* const> lights, float voxels,
                  const core::Vec2& u_lens);
    std::unique_ptr<SharedRayTask> start() const override;

    /// What all tasks that have ended did; call it when none is running. A ray counts once for each light.
    const MarchScratch& done() const { return done_; }

  private:
    class Task;
    const core::RayQueries& scene_;
    EyeView eye_;
    std::span<const InScattering* const> lights_;
    float voxels_;
    core::Vec2 u_lens_;
    mutable std::mutex mutex_;
    mutable MarchScratch done_;
};

}  // namespace mote::screenspace
