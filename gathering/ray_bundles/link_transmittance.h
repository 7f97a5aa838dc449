// Transmittance of media and panes along the links of a bundle.
#pragma once

#include <memory>
#include <span>

#include "core/scene/ray_queries.h"
#include "gathering/ray_bundles/ray_bundle.h"
#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

class LinkTransmittance {
  public:
    /// `shapes` are those of the triangles; `outermost` is the medium outside of all of them, or null. Keeps
    /// references to all. Superfluous where nothing attenuates (RayQueries::attenuates()).
    LinkTransmittance(const core::RayQueries& scene, std::span<const std::shared_ptr<core::Shape>> shapes,
                      const SurfaceTriangles& triangles, const core::Medium* outermost)
        : scene_(scene), shapes_(shapes), triangles_(triangles), outermost_(outermost) {}

    /// Estimates the transmittance along a ray with n hits: between[i], for i < n - 1, becomes an unbiased
    /// estimate per channel between hits i and i + 1; it holds both ways. Estimates of one ray share no
    /// random numbers. Safe from many threads.
    void along(const RayBundle& bundle, std::size_t ray, core::Rng& rng, core::TrackingCounters& counters,
               std::span<core::Rgb> between) const;

  private:
    const core::RayQueries& scene_;
    std::span<const std::shared_ptr<core::Shape>> shapes_;
    const SurfaceTriangles& triangles_;
    const core::Medium* outermost_;
};

}  // namespace mote::gathering
