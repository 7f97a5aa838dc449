// Points that represent the surfaces of a scene: discs of one radius, each for an equal part of the area.
#pragma once

#include <span>
#include <vector>

#include "core/objects/cancellation.h"
#include "gathering/ray_bundles/surface_points.h"

namespace mote::gathering {

/// All arrays have one entry a point.
struct Surfels {
    std::vector<core::Vec3> positions;  ///< [m]
    std::vector<core::Vec3> normals;    ///< unit, of the triangle, on its front
    std::vector<SurfacePoint> places;   ///< on which triangle, and where
    float radius = 0.0f;                ///< of the discs, which together hide the surface [m]
    double area = 0.0;                  ///< of the surface: each point represents area / size() [m^2]

    std::size_t size() const { return positions.size(); }                             ///< how many points
    double patch() const { return positions.empty() ? 0.0 : area / double(size()); }  ///< [m^2]
};

/// Settings of the choice of points, and the size of their discs.
struct SurfelSettings {
    std::uint64_t seed = 1;  ///< determines the points, on any number of threads
    /// Candidates for each point: more make the points more even, and take as much longer.
    std::uint32_t candidates = 8;
    std::size_t memory_budget = std::size_t(1) << 30;  ///< while points are chosen [B]
    core::CancelToken cancelled = {};
};

/// `count` points as blue noise, by dart throwing with a distance that shrinks (McCool & Fiume 1992): of
/// candidates that are uniform over the area, in random order, those farther from all points so far than the
/// distance become points, until there are `count`. Points on surfaces that face away from each other (thin
/// walls) do not keep their distance. Fewer points, none, where there is no area. Throws InputError where
/// `count` is above 2^24 or what it takes exceeds the budget, naming the count that fits, and for no
/// candidates.
Surfels blue_noise_surfels(const SurfaceTriangles& triangles, std::uint32_t count,
                           const SurfelSettings& settings = {});

/// Throws the InputError of blue_noise_surfels() for points beyond the budget, and does nothing else.
void check_surfel_memory(std::uint32_t count, const SurfelSettings& settings);

}  // namespace mote::gathering
