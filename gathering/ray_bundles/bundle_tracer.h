// Builds ray-bundles through one set of triangles, for many directions.
//
// Either form finds the same hits to the bit: rays of Embree, sixteen at a time, which find the triangles
// near them in a hierarchy; or a scan of all triangles over the grid. The first has less to do where many
// triangles fall between two rays, the second where a triangle has many rays.
#pragma once

#include <memory>
#include <mutex>

#include "core/objects/cancellation.h"
#include "gathering/ray_bundles/bundle_assembly.h"
#include "gathering/ray_bundles/ray_bundle.h"
#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

class RayForm;
class TriangleCull;

/// Methods of finding hits.
enum class BundleForm : std::uint8_t {
    automatic,  ///< the one that should be faster
    rays,       ///< packets of rays through a hierarchy
    scan        ///< rays where sorting the triangles takes more than the budget
};

/// Settings of one bundle.
struct BundleSettings {
    BundleForm form = BundleForm::automatic;           ///< how hits are found
    std::size_t memory_budget = std::size_t(1) << 30;  ///< of the bundle's hits [B]
    core::CancelToken cancelled = {};                  ///< throws Cancelled
};

/// Traces bundles through one list of triangles.
class BundleTracer {
  public:
    /// Keeps a reference to the triangles. Throws InputError for a corner that is not finite or beyond 1e18,
    /// naming the triangle, and for more than 2^31 triangles.
    explicit BundleTracer(const SurfaceTriangles& triangles);
    ~BundleTracer();
    BundleTracer(const BundleTracer&) = delete;
    BundleTracer& operator=(const BundleTracer&) = delete;

    const SurfaceTriangles& triangles() const { return triangles_; }  ///< those that it was made of
    /// All hits of every ray from its origin on, in order. Parallel within, safe from many threads, the same
    /// bits for any number of them. Throws InputError where the hits exceed the budget, Cancelled when it is
    /// cancelled.
    RayBundle trace(const BundleGrid& grid, const BundleSettings& settings = {}) const;

    /// Form that `automatic` selects, rays or scan, by the number of triangles for each hit.
    BundleForm plan(const BundleGrid& grid) const;

  private:
    const RayForm& ray_form() const;
    const TriangleCull& cull() const;

    const SurfaceTriangles& triangles_;
    core::Bounds3 bounds_;
    double area_ = 0.0;  // [m^2]
    mutable BandScratch scratch_;
    // Made when they are first needed.
    mutable std::once_flag ray_form_once_, cull_once_;
    mutable std::unique_ptr<const RayForm> ray_form_;
    mutable std::unique_ptr<const TriangleCull> cull_;
};

}  // namespace mote::gathering
