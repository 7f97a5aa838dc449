// A k-d tree over receivers by position and normal: the slices of LightSlice (Ou and Pellacini 2011), and
// strata within them.
//
// Split near the median of the coordinate that spreads most, until there are as many leaves as wanted. A
// receiver has seven coordinates: its position in units of the largest extent of all, its normal times a
// quarter, zero in a medium, and 1 or 0 for a medium.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::lights {

struct SlicePoint {
    core::Vec3 position{0.0f};  ///< [m]
    core::Vec3 normal{0.0f};    ///< unit; zero in a medium
};

class SliceTree {
  public:
    SliceTree() = default;
    /// At most `groups` of them, with about as many points each; fewer where there are fewer points, or too
    /// many in one. The same for the same points in the same order.
    SliceTree(std::span<const SlicePoint> sites, std::size_t groups);

    std::size_t groups() const { return first_.empty() ? 0 : first_.size() - 1; }
    /// Indices of the points of a group.
    std::span<const std::uint32_t> group(std::size_t g) const {
        return std::span(order_).subspan(first_[g], first_[g + 1] - first_[g]);
    }
    /// Group of any point. Precondition: there is a group.
    std::size_t find(const SlicePoint& site) const;

  private:
    using Point = std::array<float, 7>;
    struct Node {
        int axis = -1;  ///< -1: a group
        float cut = 0.0f;
        std::uint32_t left = 0, right = 0;  ///< nodes; of a group, left is its number
    };
    Point point(const SlicePoint& site) const;
    std::uint32_t close(std::uint32_t node, std::size_t last);
    std::uint32_t build(std::span<const Point> points, std::size_t first, std::size_t last,
                        std::size_t groups);

    core::Vec3 lower_{0.0f};
    float scale_ = 0.0f;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<std::size_t> first_;
};

}  // namespace mote::lights
