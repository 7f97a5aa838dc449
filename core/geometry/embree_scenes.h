// The shapes of a scene as Embree traces them: two scenes, and for every group of instanced shapes two more
// that its instances share.
#pragma once

#include <atomic>
#include <map>

#include "core/geometry/embree_shapes.h"
#include "core/geometry/instances.h"
#include "core/geometry/mesh_checks.h"
#include "core/objects/memory_budget.h"

namespace mote::core::embree {

/// Some builds of Embree (Debian's) abort on rays that are not finite or start beyond what it can trace, in
/// the space of an instance too (ShapeScenes::max_ray_origin): those hit nothing.
inline bool traceable(const Vec3& origin, const Vec3& direction, float t_min, float t_max, float max_origin) {
    // Without branches: bits as integers, since Clang takes & of calls for a mistake.
    const auto below = [](const Vec3& v, float limit) {
        return int(std::fabs(v.x) < limit) & int(std::fabs(v.y) < limit) & int(std::fabs(v.z) < limit);
    };
    const int inside = below(origin, max_origin) & below(direction, largest_coordinate);
    return (inside & int(std::fabs(t_min) < infinity) & int(t_max >= t_min)) != 0;
}

/// t_max of a packet's lane for Embree. A packet wider than the processor's vectors is split by Embree 3,
/// which then reads no mask of lanes: only t_max < t_min keeps it from a ray that is not finite (Debian's
/// Embree aborts there).
inline float t_max_of_lane(int valid, float t_max) { return valid ? t_max : -infinity; }

/// The unit for a scene of these shapes.
TracingUnit unit_for(std::span<const std::shared_ptr<Shape>> shapes);

class ShapeScenes {
  public:
    explicit ShapeScenes(TracingUnit unit, const MemoryBudget& memory = {});
    ShapeScenes(const ShapeScenes&) = delete;
    ShapeScenes& operator=(const ShapeScenes&) = delete;

    /// Keeps a pointer to the shape, which must outlive this.
    void attach(const Shape& shape);
    /// After the last shape. Throws std::logic_error when shapes of an instance are missing, OutOfMemory
    /// where Embree's trees exceed the budget.
    void build();

    RTCScene surfaces() const { return scenes_[0].get(); }
    RTCScene boundaries() const { return scenes_[1].get(); }
    std::size_t boundary_count() const { return boundaries_; }
    std::size_t pane_count() const { return panes_; }  ///< among the boundaries
    std::size_t surface_primitives() const { return surface_primitives_; }
    std::size_t memory_bytes() const { return std::size_t(std::max<std::int64_t>(0, memory_.used)); }
    Bounds3 bounds() const { return bounds_; }
    TracingUnit unit() const { return unit_; }  ///< of rays
    /// Bound of the coordinates of a ray's origin, in the world [m], that Embree can trace through all
    /// instances.
    float max_ray_origin() const { return max_ray_origin_; }

    /// The shape that was hit, as Embree traces it: of an instanced shape the original.
    const TracedShape& shape_of(const RawHit& raw) const {
        if (raw.instance == RTC_INVALID_GEOMETRY_ID) return *entries_[raw.geometry].shape;
        return entries_[raw.instance].shared->shapes[raw.geometry];
    }
    void fill_hit(const Ray& ray, const RawHit& raw, SurfaceHit& hit) const;

  private:
    /// Shared by all instances of a group. Geometries are numbered as the group's shapes are.
    struct SharedScenes {
        Scene scenes[2];
        std::size_t members[2] = {0, 0};
        std::vector<TracedShape> shapes;
        TracingUnit unit;  // of the group's space
    };
    /// A geometry at the top: a shape, or an instance of shapes.
    struct Entry {
        std::optional<TracedShape> shape;
        const SharedScenes* shared = nullptr;
        std::vector<const InstancedShape*> placed;  // by their number in the group
    };

    Scene new_scene() const;
    void attach_geometry(RTCScene to, const TracedShape& shape, std::size_t number) const;
    void attach_instanced(const InstancedShape& shape);
    void attach_instance(RTCScene to, const SharedScenes& group, std::size_t which,
                         const Placement& placement) const;
    const SharedScenes& shared_scenes(const ShapeGroup& group);
    void check(const char* step) const;

    /// Memory of Embree [B], and what it may take.
    struct Memory {
        std::atomic<std::int64_t> used{0};
        MemoryBudget budget;
    };
    static bool count_memory(void* memory, ssize_t bytes, bool done);
    Memory memory_;  // outlives the device
    Device device_;
    Scene scenes_[2];
    std::vector<Entry> entries_;  // by Embree's geometry number at the top
    std::map<const ShapeGroup*, SharedScenes> shared_;
    std::map<const Placement*, std::size_t> instances_;  // their entries
    std::size_t boundaries_ = 0, panes_ = 0, surface_primitives_ = 0;
    Bounds3 bounds_;
    TracingUnit unit_;
    float max_ray_origin_;
};

}  // namespace mote::core::embree
