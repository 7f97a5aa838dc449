// From shapes to Embree geometries and back: meshes share their buffers, analytic shapes answer by callback.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/curves.h"
#include "core/geometry/embree_api.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::core::embree {

/// Unit of length of Embree's geometry: a power of two, lengths in metres times it are what Embree holds.
/// Rays have their origin and direction times it, so that distances along them are those in metres.
struct TracingUnit {
    float per_metre = 1.0f;

    /// Brings very small scenes to the size of 1: products of three lengths, as in the triangle test, leave
    /// single precision below some 1e-9 m. `reach`: largest coordinate [m].
    static TracingUnit of(float reach) {
        constexpr float small = 0x1p-10f;  // larger scenes share their meshes' memory with Embree
        if (!(reach > 0.0f) || reach >= small) return {};
        return {std::ldexp(1.0f, -std::max(std::ilogb(reach), -100))};
    }
};

/// An analytic shape as Embree's callbacks get it.
struct AnalyticGeometry {
    const AnalyticShape& shape;
    TracingUnit unit;
};

/// A shape that Embree traces by itself (no InstancedShape). It must outlive this.
class TracedShape {
  public:
    TracedShape(const Shape& shape, TracingUnit unit);

    const Shape& shape() const { return *shape_; }
    const TriangleMesh* mesh() const { return mesh_; }  ///< null: it is none
    Geometry make_geometry(RTCDevice device) const;
    /// Fills a hit except t. The direction need not have unit length.
    void fill_hit(const Vec3& origin, const Vec3& direction, const RawHit& raw, SurfaceHit& hit) const;
    /// Two hits of one primitive on a ray are the same hit; a quadric has two that differ.
    bool once_per_primitive() const { return mesh_ != nullptr; }

  private:
    const Shape* shape_;
    const TriangleMesh* mesh_;                    // or null
    std::unique_ptr<AnalyticGeometry> analytic_;  // or null; Embree has its address
    const Curves* curves_;                        // or null
    TracingUnit unit_;
};

/// Filter that records every hit in Query::collected and lets the ray continue.
void collect_hits(const RTCFilterFunctionNArguments* arguments);

}  // namespace mote::core::embree
