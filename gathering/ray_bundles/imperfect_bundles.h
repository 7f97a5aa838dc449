// Ray-bundles through points instead of triangles (Tokuyoshi & Ogaki 2012, "Imperfect ray-bundle tracing"):
// their time does not depend on how many triangles there are.
//
// Each direction has another set of points. A point represents a patch of the surface, by a disc in its
// triangle's plane. The poster samples a triangle around the disc in tangent space and cuts the disc out of
// it; on the grid that is an ellipse, whose rays are found row by row. Where discs do not meet there are
// holes, through which light leaks; larger discs close them, and overlap: a ray then has several hits of one
// surface, close to each other and from the same side, which make no links.
#pragma once

#include "core/objects/cancellation.h"
#include "gathering/ray_bundles/bundle_assembly.h"
#include "gathering/ray_bundles/point_pool.h"

namespace mote::gathering {

struct ImperfectSettings {
    /// Radius of a disc in units of that whose area is a point's patch: at 1 discs have the surface's area.
    float splat_size = 1.0f;
    /// Hits from one side within this fraction of a disc's radius along the ray are one surface's: the first
    /// of them is kept.
    float merge = 0.5f;
    std::size_t memory_budget = std::size_t(1) << 30;  ///< of the bundle's hits [B]
    core::CancelToken cancelled = {};
};

class ImperfectBundles {
  public:
    /// Samples `sets` sets of `points` points each: 60 bytes a point. Does not refer to the triangles later.
    /// Throws InputError for no points or sets, or more than 2^24.
    explicit ImperfectBundles(const SurfaceTriangles& triangles, std::uint32_t points = 16384,
                              std::uint32_t sets = 32);

    double disc_radius(const ImperfectSettings& settings) const;  ///< [m]
    /// Hits of the discs of set `set` (modulo their number) of points. They name the triangle of the disc;
    /// beside that triangle u and v are those of its nearest border. Same bits for any number of threads.
    /// Throws InputError where the hits exceed the budget or the splat size is not positive, Cancelled when
    /// it is cancelled.
    RayBundle trace(const BundleGrid& grid, std::uint64_t set, const ImperfectSettings& settings = {}) const;
    std::size_t memory_bytes() const { return pool_.memory_bytes(); }

  private:
    core::Bounds3 bounds_;
    PointPool pool_;
    mutable BandScratch scratch_;
};

}  // namespace mote::gathering
