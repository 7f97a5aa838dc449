// Points spread evenly by area over all surfaces of a scene: what imperfect shadow maps are made of.
//
// They are where straight lines through everything meet surfaces. Lines that are uniform within a sphere of
// radius R meet a piece of surface in proportion to its area, wherever and however it lies: A / (2 pi R^2)
// times a line: the density of a point is 1 / A per area A of all surfaces [1/m^2]. So no shape needs a
// sampler of its own, and instances, meshes and balls are alike, also of scenes that are no list of triangles
// (gathering/ray_bundles/surface_points.h samples those).
#pragma once

#include <vector>

#include "core/scene/ray_queries.h"

namespace mote::lights {

struct SurfaceSample {
    core::Vec3 position, normal;  ///< geometric, to either side
};

/// A sample of all surfaces.
struct SurfaceSamples {
    std::vector<SurfaceSample> points;  ///< in random order: any range of them is a sample of all
    float density = 0.0f;               ///< points per area [1/m^2]; 0: there are no surfaces

    /// The radius of discs that cover a surface `coverage` times in the mean, of `count` of the points [m].
    float radius(std::size_t count, float coverage) const;
};

/// `count` points, or fewer where 64 lines a point do not find as many. On the threads of TBB; the same for
/// any number of them.
SurfaceSamples sample_surfaces(const core::RayQueries& scene, std::size_t count, std::uint64_t seed);

}  // namespace mote::lights
