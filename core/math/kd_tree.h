// The k nearest of many points: a balanced kd-tree without pointers (Bentley 1975; Jensen 2001, Ch. 6).
//
// The points are put into the tree's order once: the root of every range [first, last) is its middle element,
// what lies below the root's plane comes before it, the rest behind. Besides the points in that order the
// tree keeps one byte a point, the axis of its plane. The caller orders its own data by order() and speaks of
// points by their index in it from then on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

class KdTree {
  public:
    struct Neighbour {
        float distance_squared;
        std::uint32_t index;  ///< index in the tree's order
        bool operator<(const Neighbour& o) const {
            return distance_squared != o.distance_squared ? distance_squared < o.distance_squared
                                                          : index < o.index;
        }
    };

    KdTree() = default;
    /// Builds in parallel, in O(n log n); the result depends on the points alone. At most 2^32 - 1 finite
    /// points.
    explicit KdTree(std::span<const Vec3> points);

    std::size_t size() const { return points_.size(); }
    /// order()[i] is the index, in the span given to the constructor, of the point at i.
    std::span<const std::uint32_t> order() const { return order_; }
    /// Frees order(), once the caller has put its data into it.
    void forget_order() { order_ = {}; }
    const Vec3& point(std::uint32_t index) const { return points_[index]; }

    /// The `k` points nearest to p and not farther than `max_distance`, as a max-heap: the farthest of them
    /// first. Fewer where there are fewer. `heap` is cleared first; its memory is reused.
    void nearest(const Vec3& p, std::size_t k, float max_distance, std::vector<Neighbour>& heap) const;

    static constexpr std::size_t bytes_per_point = sizeof(Vec3) + 1;  ///< once the order is forgotten
    std::size_t memory_bytes() const {
        return size() * bytes_per_point + order_.size() * sizeof(std::uint32_t);
    }

  private:
    struct Search;
    void build(std::span<const Vec3> points, std::size_t first, std::size_t last);
    void search(Search& s, std::size_t first, std::size_t last) const;

    std::vector<Vec3> points_;
    std::vector<std::uint8_t> axes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace mote::core
