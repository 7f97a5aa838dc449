// In-scattering of one light through a camera: in_scattering_source.h implemented by rays into a scene.
#pragma once

#include <mutex>

#include "screenspace/in_scattering/eye_view.h"
#include "screenspace/in_scattering/in_scattering.h"

namespace mote::screenspace {

/// Keeps references to scene and light march. All rays pass the point `u_lens` of the lens.
class InScatteringRays final : public InScatteringSource {
  public:
    /// Through any camera.
    InScatteringRays(const core::RayQueries& scene, EyeView eye, const InScattering& light,
                     const core::Vec2& u_lens)
        : scene_(scene), eye_(std::move(eye)), light_(light), u_lens_(u_lens) {}
    /// Through the scene's own camera.
    InScatteringRays(const core::Scene& scene, const InScattering& light, const core::Vec2& u_lens);
    std::unique_ptr<InScatteringTask> start() const override;

    /// Counts over all tasks that have ended; call it when none is running.
    const core::RayCounters& rays() const { return rays_; }
    const core::TrackingCounters& tracking() const { return tracking_; }  ///< the same in media
    std::uint64_t marched() const { return marched_; }                    ///< rays
    std::uint64_t steps() const { return steps_; }                        ///< of all rays
    std::uint64_t unoccluded() const { return unoccluded_; }              ///< rays that needed none

  private:
    class Task;
    const core::RayQueries& scene_;
    EyeView eye_;
    const InScattering& light_;
    core::Vec2 u_lens_;
    mutable std::mutex mutex_;
    mutable core::RayCounters rays_;
    mutable core::TrackingCounters tracking_;
    mutable std::uint64_t marched_ = 0, steps_ = 0, unoccluded_ = 0;
};

/// The first surface on an eye ray.
struct FirstSurface {
    float distance = core::infinity;  ///< [m]; infinity where there is none
    core::Vec3 normal{0.0f};          ///< geometric, unit
};
/// The end of the lit part of an eye ray whose first surface is known.
RayEnd lit_end(const InScattering& light, const core::Ray& ray, const FirstSurface& surface);

}  // namespace mote::screenspace
