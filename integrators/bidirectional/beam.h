// The edges of a subpath as beams: every point of one in a medium is a vertex that the path could have had.
//
// A long beam reaches the first surface; light passes along it with an unbiased estimate of the
// transmittance. A short one is as long as the path went: the estimate is whether it came there, and exact
// where the media are grey, or homogeneous, which leaves ratios of transmittances in closed form.
#pragma once

#include <vector>

#include "core/scene/transmittance_along.h"
#include "integrators/bidirectional/subpath.h"

namespace mote::integrators {

struct Beam {
    core::Ray ray;                             ///< t_max: the first surface
    float reached = 0.0f;                      ///< as far as the path came along it [m]
    core::MediumState state;                   ///< media at its origin
    core::PathWeights weights;                 ///< of the path there
    std::vector<core::SurfaceHit> boundaries;  ///< of media along it, and panes
    std::size_t index = 1;                     ///< that its points have as vertices
    double density = 1.0;   ///< of its direction per solid angle, or, if `parallel`, per area across it
    bool parallel = false;  ///< it comes from infinity, or all rays of the camera are parallel
    double others = 0.0;    ///< PathVertex::others of its points
    int scatterings = 0;    ///< likewise
    bool surface_first = true;

    float end(BeamLength length) const { return length == BeamLength::short_beam ? reached : ray.t_max; }
};

/// Short beams need all media to scatter, and to be grey or homogeneous: elsewhere the weight of a path that
/// did not end there is not known.
bool short_beams_possible(const core::RayQueries& scene);

/// Weight of the beam's path at growing distances along it, without what scatters there.
class BeamWeight {
  public:
    /// Keeps references.
    BeamWeight(const Beam& beam, BeamLength length, core::WalkContext& context);

    /// Weight per channel at t, which must not be nearer than before.
    core::Rgb advance_to(float t);
    /// At that distance, or null.
    const core::Medium* medium() const {
        return length_ == BeamLength::long_beam ? along_.state().current() : state_.current();
    }

  private:
    core::Rgb short_advance_to(float t);
    void pass(float t);

    const Beam& beam_;
    BeamLength length_;
    core::TransmittanceAlong along_;  // of long beams; what follows of short ones
    core::MediumState state_;
    std::span<const core::SurfaceHit> boundaries_;
    core::TrackingCounters& counters_;
    core::Rgb throughput_, unidirectional_;
    float t_;
};

/// Fills what all vertices on the beam have in common.
void start_on_beam(const Beam& beam, PathVertex& vertex);
/// Moves such a vertex to distance t of the beam, which `path` would have continued by; coefficients are left
/// as they are.
void move_on_beam(const core::RayQueries& scene, const Subpath& path, const Beam& beam, float t,
                  core::TrackingCounters& counters, PathVertex& vertex);
/// Coefficients of the medium and merges there; `on_surface` vertices have none of the former.
void set_merges(const Subpath& path, const core::MediumCoefficients& at, PathVertex& vertex);

}  // namespace mote::integrators
