// Bundles that are kept as grids, and looked up instead of traced: what a point sees along a line is the next
// hit of the grid's ray that is nearest to it (Tokuyoshi & Ogaki 2012, Sec. 3; with discs around points
// instead of triangles, Tokuyoshi & Ogaki 2012b).
//
// Once made, a bundle serves all points, first ones and those of later bounces. Where a point lies between
// rays it sees what the ray sees: edges and contacts move by up to half a spacing, which biases light there.
#pragma once

#include <memory>
#include <optional>

#include "core/scene/scattering_vertex.h"
#include "gathering/atlas/surface_place.h"
#include "gathering/ray_bundles/bundle_tracer.h"
#include "gathering/ray_bundles/imperfect_bundles.h"

namespace mote::gathering {

struct KeptLinkSettings {
    bool imperfect = false;
    float spacing = 0.0f;                              ///< of the rays [m]; 0: 1/256 of the scene's diagonal
    std::uint32_t points = 16384;                      ///< of an imperfect bundle
    float splat_size = 1.4f;                           ///< ImperfectSettings
    std::size_t memory_budget = std::size_t(2) << 30;  ///< of all bundles of a pass [B]
};

/// What lies at the other end of a link.
struct LinkEnd {
    std::optional<core::SurfaceHit> hit;  ///< nothing: the line leaves the scene
    float distance = 0.0f;                ///< [m]
};

class KeptLinks {
  public:
    /// `shapes` must outlive it. Throws InputError as BundleTracer and ImperfectBundles do.
    KeptLinks(ShapeSpan shapes, const KeptLinkSettings& settings);

    /// The bundle along a direction; `number` moves its grid and chooses the set of points, and `bundles`
    /// share the budget. Throws InputError, Cancelled.
    RayBundle bundle(const core::Vec3& direction, std::uint64_t number, std::size_t bundles,
                     core::CancelToken cancelled) const;
    /// From x along w, which is the bundle's direction or its opposite. Nothing where the ray of the grid
    /// does not know the surface at x, and nobody can say what comes after it.
    std::optional<LinkEnd> next(const RayBundle& bundle, const core::ScatteringVertex& x,
                                const core::Vec3& w) const;

  private:
    core::SurfaceHit place(const BundleHit& hit) const;

    ShapeSpan shapes_;
    KeptLinkSettings settings_;
    SurfaceTriangles surfaces_;
    std::unique_ptr<const BundleTracer> exact_;
    std::unique_ptr<const ImperfectBundles> imperfect_;
    float spacing_, reach_;  ///< reach_: how far a hit may lie from x across the ray [m]
};

}  // namespace mote::gathering
