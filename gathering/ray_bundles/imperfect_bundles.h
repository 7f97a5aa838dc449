// Ray-bundles through points instead of triangles (Tokuyoshi & Ogaki 2012, "Imperfect ray-bundle tracing"):
// their time does not depend on how many triangles there are.
//
// Each direction has another set of points. A point stands for a patch of the surface, by a disc in its
// triangle's plane. The poster draws a triangle around the disc in tangent space and cuts the disc out of it;
// on the grid that is an ellipse, whose rays are found row by row. Where discs do not meet there are holes,
// through which light leaks; larger discs close them, and overlap: a ray then has several hits of one
// surface, close to each other and from the same side, which make no links.
#pragma once

#include "core/objects/cancellation.h"
#include "gathering/ray_bundles/ray_bundle.h"
#include "gathering/ray_bundles/splats.h"

namespace mote::gathering {

struct ImperfectSettings {
    std::uint32_t points = 16384;  ///< of each direction
    /// Radius of a disc in units of that whose area is a point's patch: at 1 discs have the surface's area.
    float splat_size = 1.4f;
    /// Hits from one side within this share of a disc's radius along the ray are one surface's: the first of
    /// them is kept.
    float merge = 0.5f;
    std::size_t memory_budget = std::size_t(1) << 30;  ///< of the bundle's hits [B]
    core::CancelToken cancelled = {};
};

class ImperfectBundles {
  public:
    /// Keeps a reference to the triangles.
    explicit ImperfectBundles(const SurfaceTriangles& triangles);

    double disc_radius(const ImperfectSettings& settings) const;  ///< [m]
    /// What points number `set` hide. Hits name the triangle of the disc; beside that triangle u and v are
    /// those of its nearest border. Same bits for any number of threads. Throws InputError where the hits
    /// exceed the budget or the splat size is not positive, Cancelled when asked to stop.
    RayBundle trace(const BundleGrid& grid, std::uint64_t set, const ImperfectSettings& settings = {}) const;

  private:
    std::vector<Splat> splats(const BundleGrid& grid, std::uint64_t set, std::uint32_t count,
                              float radius) const;

    const SurfaceTriangles& triangles_;
    SurfacePoints points_;
};

}  // namespace mote::gathering
