// Imperfect bundles that are looked up instead of traced (Tokuyoshi & Ogaki 2012b): a point sees along a line
// the next hit of the grid's ray that is nearest to it.
//
// A bundle serves all points of a pass, first ones and those of later bounces. Between rays a point sees what
// the ray sees, and through holes between discs light passes: both bias the light there.
#pragma once

#include <optional>

#include "core/scene/scattering_vertex.h"
#include "gathering/atlas/surface_place.h"
#include "gathering/ray_bundles/imperfect_bundles.h"

namespace mote::gathering {

struct ImperfectLinkSettings {
    std::uint32_t points = 16384;  ///< of a bundle, as in the poster
    /// ImperfectSettings. Wide enough to close most holes: at 1 half of the links are missing
    /// (docs/gallery/tokuyoshi_b_imperfect.md).
    float splat_size = 1.4f;
    std::size_t memory_budget = std::size_t(2) << 30;  ///< of all bundles of a pass [B]
};

/// The other end of a link.
struct LinkEnd {
    std::optional<core::SurfaceHit> hit;  ///< nothing: the line leaves the scene
    float distance = 0.0f;                ///< [m]
};

class ImperfectLinks {
  public:
    /// `shapes` must outlive it. Throws InputError as ImperfectBundles does.
    explicit ImperfectLinks(ShapeSpan shapes, const ImperfectLinkSettings& settings = {});

    /// The bundle along a direction, with rays 1/256 of the scene's diagonal apart; `number` moves its grid
    /// and chooses the set of points, and `bundles` share the budget. Throws InputError, Cancelled.
    RayBundle bundle(const core::Vec3& direction, std::uint64_t number, std::size_t bundles,
                     core::CancelToken cancelled) const;
    /// From x along w, which is the bundle's direction or its opposite. Nothing where the ray of the grid
    /// has no hit of the surface at x.
    std::optional<LinkEnd> next(const RayBundle& bundle, const core::ScatteringVertex& x,
                                const core::Vec3& w) const;

  private:
    core::SurfaceHit place(const BundleHit& hit) const;

    ShapeSpan shapes_;
    ImperfectLinkSettings settings_;
    SurfaceTriangles surfaces_;
    ImperfectBundles imperfect_;
    float spacing_, reach_;  ///< reach_: how far a hit may lie from x across the ray [m]
};

}  // namespace mote::gathering
