// Places, parted into groups of like position and normal: the slices of receivers of LightSlice (Ou and
// Pellacini 2011), and strata within them.
//
// Cut in two near the median of the coordinate that spreads most, until there are as many groups as asked
// for. A place has seven coordinates: its position in units of the largest extent of all, its normal times a
// quarter, zero in a medium, and whether it is in a medium.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::lights {

struct Place {
    core::Vec3 position{0.0f};  ///< [m]
    core::Vec3 normal{0.0f};    ///< unit; zero in a medium
};

class PlaceTree {
  public:
    PlaceTree() = default;
    /// At most `groups` of them, with about as many places each; fewer where there are fewer places, or too
    /// many in one. The same for the same places in the same order.
    PlaceTree(std::span<const Place> places, std::size_t groups);

    std::size_t groups() const { return first_.empty() ? 0 : first_.size() - 1; }
    /// Indices of the places of a group.
    std::span<const std::uint32_t> group(std::size_t g) const {
        return std::span(order_).subspan(first_[g], first_[g + 1] - first_[g]);
    }
    /// The group that any place falls into. Precondition: there is one.
    std::size_t find(const Place& place) const;

  private:
    using Point = std::array<float, 7>;
    struct Node {
        int axis = -1;  ///< -1: a group
        float cut = 0.0f;
        std::uint32_t left = 0, right = 0;  ///< nodes; of a group, left is its number
    };
    Point point(const Place& place) const;
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
