// The boxes that a ray, or sixteen neighbouring ones, pass, out of many: Embree's hierarchy, for code that
// tests what is in the boxes by rules of their own.
#pragma once

#include <memory>
#include <span>

#include "core/geometry/shadow_packet.h"
#include "core/math/bounds.h"
#include "core/math/ray.h"

namespace mote::core {

class BoxHierarchy {
  public:
    /// Throws InputError for a box that is empty, not finite, or beyond 1e18.
    explicit BoxHierarchy(std::span<const Bounds3> boxes);
    ~BoxHierarchy();
    BoxHierarchy(const BoxHierarchy&) = delete;
    BoxHierarchy& operator=(const BoxHierarchy&) = delete;

    /// Calls visit(box, lanes) for every box that a ray of the packet passes within (t_min, t_max), in any
    /// order; bit i of `lanes` is set for ray i. A box may be visited several times, but by each ray once;
    /// rays that pass a box at less than rounding may be left out or reported. Safe from many threads.
    template <typename Visit>
    void for_each_box(const ShadowPacket& packet, const Visit& visit) const {
        visit_boxes(
            packet,
            [](const void* v, std::uint32_t box, std::uint32_t lanes) {
                (*static_cast<const Visit*>(v))(box, lanes);
            },
            &visit);
    }
    /// Likewise of one ray: visit(box).
    template <typename Visit>
    void for_each_box(const Ray& ray, const Visit& visit) const {
        visit_boxes(
            ray,
            [](const void* v, std::uint32_t box, std::uint32_t) { (*static_cast<const Visit*>(v))(box); },
            &visit);
    }
    std::size_t memory_bytes() const;

  private:
    using Visitor = void (*)(const void* visit, std::uint32_t box, std::uint32_t lanes);
    void visit_boxes(const ShadowPacket& packet, Visitor visitor, const void* visit) const;
    void visit_boxes(const Ray& ray, Visitor visitor, const void* visit) const;

    struct Implementation;
    std::unique_ptr<Implementation> impl_;
};

}  // namespace mote::core
