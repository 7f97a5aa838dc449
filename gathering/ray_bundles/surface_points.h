// Points on surfaces, one for each patch of equal area: what imperfect bundles see of a scene.
#pragma once

#include <cstdint>
#include <vector>

#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

struct SurfacePoint {
    std::uint32_t triangle;  ///< of the list that the points were sampled on
    float u, v;              ///< barycentric: (1 - u - v) c0 + u c1 + v c2
};

/// Samples points on the surface of a list of triangles, with the density 1 / area() per area [1/m^2].
class SurfacePoints {
  public:
    /// Orders the triangles along a Morton curve, so that a fraction of the area in this order is a patch.
    /// Triangles without area, or with corners that are not finite, get no points.
    explicit SurfacePoints(const SurfaceTriangles& triangles);

    double area() const { return area_; }  ///< [m^2]
    /// Points [begin, end) of `count` that are uniform over the surface, one in each of as many patches of
    /// area() / count. Within a triangle that holds many they are a Hammersley set. `set` chooses among the
    /// sets: all points of a set are moved together, at random. Nothing where there is no area.
    void sample(std::uint64_t set, std::uint32_t count, std::uint32_t begin, std::uint32_t end,
                std::vector<SurfacePoint>& points) const;
    /// [B]
    std::size_t memory_bytes() const {
        return (order_.capacity() + guide_.capacity()) * sizeof(std::uint32_t) +
               below_.capacity() * sizeof(double);
    }

  private:
    std::vector<std::uint32_t> order_;  ///< triangles along the curve
    std::vector<double> below_;         ///< area of all before, by index in the order, and one more [m^2]
    std::vector<std::uint32_t> guide_;  ///< the index at which a fraction i / guide_.size() of the area lies
    double area_ = 0.0;
};

}  // namespace mote::gathering
