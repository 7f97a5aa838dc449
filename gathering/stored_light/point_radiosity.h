// Radiosity between points, by Jacobi iteration: every place gathers with a micro-buffer what all others sent
// (Engelhardt 2013, Sec. 8.3; Cohen & Wallace 1993).
#pragma once

#include "gathering/micro_buffers/micro_buffers.h"
#include "gathering/stored_light/surfel_sides.h"

namespace mote::gathering {

struct PointRadiositySettings {
    int bounces = 1;  ///< gathers: 0 leaves the light as it is
    /// A place in each node of this level gathers, for all places below that are near it and face its way;
    /// the others for themselves. 0: every place.
    std::uint32_t level = 0;
    std::uint64_t key = 0;  ///< of the receivers' turns
    core::CancelToken cancelled = {};
};

/// E_k+1 = E_0 + T (rho / pi) E_k by place of `sides` [W/m^2], E_0 = `arriving`, T the gather of
/// micro-buffers; after as many steps as there are bounces. Light that leaves the scene is lost. `hierarchy`
/// is of the same surfels as `sides`, and that of `buffers`. The same for any number of threads; throws
/// core::Cancelled.
std::vector<core::Rgb> point_radiosity(const PointHierarchy& hierarchy, const MicroBuffers& buffers,
                                       const SurfelSides& sides, std::vector<core::Rgb> arriving,
                                       const PointRadiositySettings& settings = {});

/// Places that gather, and the places that take their light from them.
struct GatheringPlaces {
    std::vector<std::uint32_t> gather;  ///< places that gather, along the hierarchy
    std::vector<std::uint32_t> by;      ///< by place: the entry of `gather` that it takes its light from
};
GatheringPlaces gathering_places(const PointHierarchy& hierarchy, const SurfelSides& sides,
                                 std::uint32_t level);

}  // namespace mote::gathering
