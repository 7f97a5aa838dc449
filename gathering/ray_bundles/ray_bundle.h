// A global ray-bundle (Sbert 1996): all parallel rays of one direction through a regular grid, and everything
// that each of them meets, in order.
//
// Two hits that follow each other on a ray see each other, along the direction and against it, if the sides
// that they turn towards each other are those that send and receive: this is a link, and it serves both ways.
#pragma once

#include <span>

#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

/// The rays. Ray (x, y) begins at `origin` + (x + 1/2) spacing `right` + (y + 1/2) spacing `up`, outside of
/// the bounds that the grid was made for, and stands for the area spacing^2 perpendicular to `direction`.
struct BundleGrid {
    core::Vec3 direction{0, 0, 1};  ///< unit
    core::Vec3 right{1, 0, 0}, up{0, 1, 0};
    core::Vec3 origin{0, 0, 0};
    float spacing = 1.0f;  ///< [m]
    std::uint32_t columns = 0, rows = 0;

    std::size_t rays() const { return std::size_t(columns) * rows; }
    float ray_area() const { return spacing * spacing; }  ///< [m^2]
};

struct BundleHit {
    float distance;          ///< from the ray's origin [m]
    std::uint32_t triangle;  ///< index into SurfaceTriangles; the highest bit says: from behind
    float u, v;              ///< barycentric: (1 - u - v) c0 + u c1 + v c2
};

struct RayBundle {
    BundleGrid grid;
    std::vector<std::uint32_t> first;  ///< by ray, and one more: hits of ray i are [first[i], first[i + 1])
    std::vector<BundleHit> hits;       ///< of each ray by distance

    std::span<const BundleHit> hits_of(std::size_t ray) const {
        return {hits.data() + first[ray], first[ray + 1] - first[ray]};
    }
    std::size_t memory_bytes() const {
        return first.capacity() * sizeof(std::uint32_t) + hits.capacity() * sizeof(BundleHit);
    }
};

}  // namespace mote::gathering
