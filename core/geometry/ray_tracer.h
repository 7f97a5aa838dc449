// Embree behind one small class.
//
// Shapes come in two groups, each a scene of its own: `surfaces`, which stop connections, and `boundaries`,
// which light passes straight on: null BSDFs, borders between media, and panes, which reflect a part of it
// (thindielectric). Shadow rays test the first group only; what the boundaries take and which media lie
// between them is found by Scene::transmittance.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/geometry/ray_batch.h"
#include "core/geometry/shadow_packet.h"
#include "core/geometry/shape.h"
#include "core/math/ray.h"
#include "core/objects/memory_budget.h"

namespace mote::core {

/// A ray of many, and where its first hit goes.
struct HitQuery {
    const Ray* ray;
    SurfaceHit* hit;  ///< its shape is null where there is none
};

class RayTracer {
  public:
    enum class Group { surfaces, boundaries };

    /// Keeps pointers to the shapes, which must outlive it. Boundaries are null BSDFs and panes.
    /// Throws OutOfMemory where Embree needs more than the budget.
    explicit RayTracer(std::span<const std::shared_ptr<Shape>> shapes, const MemoryBudget& memory = {});
    ~RayTracer();
    RayTracer(const RayTracer&) = delete;
    RayTracer& operator=(const RayTracer&) = delete;

    bool has_boundaries() const;
    bool has_panes() const;  ///< among the boundaries
    Bounds3 bounds() const;

    /// Closest hit in one group within (t_min, t_max).
    std::optional<SurfaceHit> closest(const Ray& ray, Group group = Group::surfaces) const;
    /// Closest hits of many rays; `coherent`: neighbours have similar directions.
    void closest(std::span<const HitQuery> rays, bool coherent) const;
    /// Closest hits of a batch of rays.
    void closest(const RayBatch& rays, bool coherent, HitBatch& hits) const;
    /// All of a hit of the batch. Precondition: the ray met a surface.
    SurfaceHit surface_hit(const RayBatch& rays, const HitBatch& hits, int i) const;
    /// True if a surface lies within (t_min, t_max).
    bool occluded(const Ray& ray) const;
    /// First hits of sixteen rays at once.
    void occluded(ShadowPacket& packet) const;
    /// Many packets in one call, in the fastest form that this Embree has.
    void occluded(std::span<ShadowPacket> packets) const;
    /// All hits of one group within (t_min, t_max), sorted by distance. Clears `hits` first.
    void all_hits(const Ray& ray, Group group, std::vector<SurfaceHit>& hits) const;
    /// Calls visit(hit) for all of them, nearest first, until it returns false. Takes no memory unless there
    /// are many.
    template <typename Visit>
    void for_each_hit(const Ray& ray, Group group, const Visit& visit) const {
        visit_hits(
            ray, group,
            [](const void* v, const SurfaceHit& hit) { return bool((*static_cast<const Visit*>(v))(hit)); },
            &visit);
    }

    std::size_t memory_bytes() const;  ///< of Embree's structures

  private:
    using Visitor = bool (*)(const void* visit, const SurfaceHit& hit);
    void visit_hits(const Ray& ray, Group group, Visitor visitor, const void* visit) const;

    struct Implementation;
    std::unique_ptr<Implementation> impl_;
};

}  // namespace mote::core
