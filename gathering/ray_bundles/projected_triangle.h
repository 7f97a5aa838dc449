// Intersections of a triangle with the rays of a bundle.
//
// An edge that two triangles share has the same two corners in both, and whether a ray passes on its left or
// right is found in both by the same operations on the same numbers: a ray between the two hits one of them,
// never both or none. A ray exactly through an edge counts as a little to the right of it and, far less,
// above (Edelsbrunner & Muecke 1990, simulation of simplicity): what rasterizers call the top-left rule.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "gathering/ray_bundles/bundle_projection.h"
#include "gathering/ray_bundles/ray_bundle.h"

namespace mote::gathering {

/// The line through two projected corners.
class ProjectedEdge {
  public:
    ProjectedEdge() = default;
    ProjectedEdge(const core::Vec3d& from, const core::Vec3d& to)
        : flipped_(from.y < to.y || (from.y == to.y && from.x > to.x)) {
        // Always the same end first, so that both triangles of an edge compute the same.
        const core::Vec3d &a = flipped_ ? to : from, &b = flipped_ ? from : to;
        a_ = glm::dvec2(a), along_ = glm::dvec2(b) - glm::dvec2(a);
    }
    /// Twice the area that the edge spans with (x, y), positive on its left; seen from the end that comes
    /// first.
    double value(double x, double y) const { return row(y) - column(x); }
    double row(double y) const { return along_.x * (y - a_.y); }
    double column(double x) const { return along_.y * (x - a_.x); }
    bool flipped() const { return flipped_; }
    /// A bit for each value that is on the left as seen from that end.
    template <std::size_t n>
    static std::uint32_t bits(const double (&values)[n]) {
        std::uint64_t result = 0;
        for (std::size_t i = 0; i < n; ++i) result |= values[i] >= 0.0 ? std::uint64_t(1) << i : 0;
        return std::uint32_t(result);
    }
    /// If true, the ray with this value is on the left of the edge, as it runs in the triangle. Edges run
    /// downwards or, if level, to the right: a little to the right, or above, of a point on the line is its
    /// left.
    bool left(double value) const { return (value >= 0.0) != flipped_; }
    double directed(double value) const { return flipped_ ? -value : value; }

  private:
    glm::dvec2 a_{0.0}, along_{0.0};
    bool flipped_ = false;
};

inline std::array<core::Vec3d, 3> project(const BundleProjection& projection,
                                          const std::array<core::Vec3, 3>& corners) {
    return {projection(corners[0]), projection(corners[1]), projection(corners[2])};
}

class ProjectedTriangle {
  public:
    ProjectedTriangle() = default;
    explicit ProjectedTriangle(const std::array<core::Vec3d, 3>& corners)
        : corners_(corners),
          edges_{ProjectedEdge(corners_[1], corners_[2]), ProjectedEdge(corners_[2], corners_[0]),
                 ProjectedEdge(corners_[0], corners_[1])} {}

    const std::array<core::Vec3d, 3>& corners() const { return corners_; }
    const ProjectedEdge& edge(std::size_t i) const { return edges_[i]; }  ///< opposite of corner i

    /// Hit of ray (x, y), or nothing, also where it passes the triangle before the ray's origin. `triangle`
    /// is its index.
    std::optional<BundleHit> hit(double x, double y, std::uint32_t triangle) const {
        const double v0 = edges_[0].value(x, y), v1 = edges_[1].value(x, y), v2 = edges_[2].value(x, y);
        const bool left = edges_[0].left(v0);
        if (edges_[1].left(v1) != left || edges_[2].left(v2) != left) return std::nullopt;
        return make_hit(x, y, v0, v1, v2, triangle);
    }
    /// Hit of a ray that passes all edges on the same side, from their values. Corners that run
    /// counter-clockwise on the grid turn their back to it.
    std::optional<BundleHit> make_hit(double x, double y, double v0, double v1, double v2,
                                      std::uint32_t triangle) const {
        if (edges_[0].left(v0)) triangle |= BundleHit::behind_bit;
        v0 = edges_[0].directed(v0), v1 = edges_[1].directed(v1), v2 = edges_[2].directed(v2);
        const double sum = v0 + v1 + v2;
        // The signs of a sliver that rounding has made a line are uncertain.
        if (sum == 0.0 || !in_box(x, y)) return std::nullopt;
        const double scale = 1.0 / sum, u = v1 * scale, v = v2 * scale;
        const double z =
            corners_[0].z + u * (corners_[1].z - corners_[0].z) + v * (corners_[2].z - corners_[0].z);
        if (!(z > 0.0)) return std::nullopt;
        return BundleHit{float(z), triangle, std::uint16_t(u * 65535.0), std::uint16_t(v * 65535.0)};
    }

  private:
    bool in_box(double x, double y) const {
        const auto &a = corners_[0], &b = corners_[1], &c = corners_[2];
        return x >= std::min(a.x, std::min(b.x, c.x)) && x <= std::max(a.x, std::max(b.x, c.x)) &&
               y >= std::min(a.y, std::min(b.y, c.y)) && y <= std::max(a.y, std::max(b.y, c.y));
    }

    std::array<core::Vec3d, 3> corners_{};
    std::array<ProjectedEdge, 3> edges_{};
};

}  // namespace mote::gathering
