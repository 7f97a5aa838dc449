// The media of a box, looked up at one place in each of its cells.
#pragma once

#include <functional>

#include "core/objects/cancellation.h"
#include "core/scene/medium_state.h"
#include "core/scene/ray_queries.h"
#include "gathering/volume_points/extinction_grid.h"

namespace mote::gathering {

/// The media around a point: Scene::medium_state_at(), or whatever a test says.
using MediumStateAt = std::function<core::MediumState(const core::Vec3&)>;

struct ScatteringPlace {
    core::Vec3 position;
    core::MediumState state;
    core::Rgb sigma_s;  ///< there, not black [1/m]
};

struct MediumSamples {
    ExtinctionGrid extinction;
    std::vector<ScatteringPlace> places;  ///< one in each cell that scatters, along a Morton curve
    double cell_volume = 0.0;             ///< [m^3]
};

/// The part of the scene that media can be met in: of those without bounds, what lies within the scene's.
core::Bounds3 media_box(const core::RayQueries& scene);

/// Cuts the box into about `cells` cells, as cubic as they go, and looks up the media at a place drawn
/// uniformly in each: sums over places, times the cell's volume, are unbiased integrals. The same for any
/// number of threads; throws core::Cancelled.
MediumSamples sample_media(const core::Bounds3& box, std::uint32_t cells, std::uint64_t key,
                           const MediumStateAt& state_at, core::CancelToken cancelled = {});

}  // namespace mote::gathering
