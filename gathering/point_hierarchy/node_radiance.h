// Light that leaves points, and its mean over the points of every node (the pull step of Engelhardt 2013,
// Sec. 8.3).
#pragma once

#include "gathering/point_hierarchy/point_hierarchy.h"

namespace mote::gathering {

class NodeRadiance {
  public:
    /// Diffuse radiance of each point in the surfels' order, on the front, and on the back where that is not
    /// empty: an empty back is black [W/(m^2 sr); divide a radiosity by pi]. Throws InputError where a span
    /// has another size than the hierarchy, or a value is not finite.
    NodeRadiance(const PointHierarchy& hierarchy, std::span<const core::Rgb> front,
                 std::span<const core::Rgb> back = {});

    /// Mean over the node's points; nodes are numbered as in PointHierarchy::nodes().
    const core::Rgb& of(std::uint32_t node, bool back) const {
        return back ? (back_.empty() ? black_ : back_[node]) : front_[node];
    }

  private:
    std::vector<core::Rgb> front_, back_;
    core::Rgb black_{0.0f};
};

}  // namespace mote::gathering
