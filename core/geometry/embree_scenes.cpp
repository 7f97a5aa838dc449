// Attaches shapes to Embree's scenes; finds its hits' shapes again.
#include "core/geometry/embree_scenes.h"

#include <new>
#include <stdexcept>

#include "core/materials/bsdf.h"
#include "core/objects/memory_error.h"

namespace mote::core::embree {
namespace {

bool is_pane(const Shape& shape) { return shape.bsdf && shape.bsdf->traits().pane; }
bool is_boundary(const Shape& shape) { return shape.bsdf && shape.bsdf->traits().passes_straight(); }

}  // namespace

TracingUnit unit_for(std::span<const std::shared_ptr<Shape>> shapes) {
    Bounds3 box;
    for (const auto& shape : shapes) box.extend(shape->bounds());
    return TracingUnit::of(max_component(glm::max(-box.lower, box.upper)));
}

/// Embree calls it before each block, and ends the build where it returns false.
bool ShapeScenes::count_memory(void* memory, ssize_t bytes, bool done) {
    auto& [used, budget] = *static_cast<Memory*>(memory);
    constexpr ssize_t small = 1 << 20;
    if (bytes >= small && !done && double(bytes) > budget.available()) return false;
    used.fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

ShapeScenes::ShapeScenes(TracingUnit unit, const MemoryBudget& memory)
    : memory_{{}, memory},
      device_(rtcNewDevice(nullptr)),
      unit_(unit),
      max_ray_origin_(largest_coordinate / unit.per_metre) {
    if (!device_) throw std::runtime_error("Embree: no device");
    rtcSetDeviceMemoryMonitorFunction(device_.get(), count_memory, &memory_);
    for (auto& s : scenes_) s = new_scene();
    check("opening");
}

void ShapeScenes::check(const char* step) const {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw OutOfMemory("Embree's trees of " + std::to_string(surface_primitives_) +
                          " triangles and other primitives, of which it has built" +
                          memory_text(double(memory_bytes())));
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error(std::string("Embree: ") + step + " failed with error " +
                                 std::to_string(int(error)));
}

Scene ShapeScenes::new_scene() const {
    Scene scene(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene.get(), RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | filter_scene_flag));
    return scene;
}

void ShapeScenes::attach(const Shape& shape) {
    boundaries_ += is_boundary(shape), panes_ += is_pane(shape);
    if (!is_boundary(shape)) surface_primitives_ += shape.primitive_count();
    bounds_.extend(shape.bounds());
    if (const auto* instanced = dynamic_cast<const InstancedShape*>(&shape)) {
        attach_instanced(*instanced);
        return;
    }
    Entry entry{TracedShape(shape, unit_), nullptr, {}};
    attach_geometry(scenes_[is_boundary(shape)].get(), *entry.shape, entries_.size());
    entries_.push_back(std::move(entry));
}

void ShapeScenes::build() {
    for (const Entry& entry : entries_)
        for (const InstancedShape* placed : entry.placed)
            if (!placed) throw std::logic_error("a shape of an instance is missing");
    for (auto& scene : scenes_) rtcCommitScene(scene.get());
    check("building");
}

void ShapeScenes::attach_geometry(RTCScene to, const TracedShape& shape, std::size_t number) const {
    rtcAttachGeometryByID(to, shape.make_geometry(device_.get()).get(), unsigned(number));
}

void ShapeScenes::attach_instanced(const InstancedShape& shape) {
    const Placement& placement = shape.placement();
    const auto [at, fresh] = instances_.emplace(&placement, entries_.size());
    if (fresh) {
        const SharedScenes& group = shared_scenes(placement.group());
        for (std::size_t i = 0; i < 2; ++i)
            if (group.members[i] > 0) attach_instance(scenes_[i].get(), group, i, placement);
        const double limit = placement.max_ray_origin() / double(group.unit.per_metre);
        if (!(limit > 1.0))  // directions, too, must stay within what Embree traces
            throw InputError("the transform of an instance is too small for its shapegroup",
                             placement.where());
        max_ray_origin_ = std::fmin(max_ray_origin_, float(limit / std::sqrt(3.0)));
        entries_.push_back({std::nullopt, &group, {}});
        entries_.back().placed.resize(group.shapes.size());
    }
    entries_[at->second].placed[shape.member()] = &shape;
}

void ShapeScenes::attach_instance(RTCScene to, const SharedScenes& group, std::size_t which,
                                  const Placement& placement) const {
    const Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    // From the group's unit of length to that of the world.
    const double unit = double(unit_.per_metre), scale = unit / double(group.unit.per_metre);
    glm::dmat4 to_world = placement.to_world().matrix;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 3; ++r) to_world[c][r] *= c < 3 ? scale : unit;
    const glm::mat4 matrix(to_world);
    rtcSetGeometryInstancedScene(geometry.get(), group.scenes[which].get());
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrix[0][0]);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(to, geometry.get(), unsigned(entries_.size()));
}

const ShapeScenes::SharedScenes& ShapeScenes::shared_scenes(const ShapeGroup& group) {
    const auto [at, fresh] = shared_.try_emplace(&group);
    SharedScenes& result = at->second;
    if (!fresh) return result;
    for (auto& s : result.scenes) s = new_scene();
    if (unit_.per_metre != 1.0f) result.unit = unit_for(group.shapes);
    for (const auto& shape : group.shapes) {
        const std::size_t i = is_boundary(*shape);
        result.shapes.emplace_back(*shape, result.unit);
        attach_geometry(result.scenes[i].get(), result.shapes.back(), result.shapes.size() - 1);
        ++result.members[i];
    }
    for (auto& s : result.scenes) rtcCommitScene(s.get());
    return result;
}

void ShapeScenes::fill_hit(const Ray& ray, const RawHit& raw, SurfaceHit& hit) const {
    hit.primitive = 0;
    if (raw.instance == RTC_INVALID_GEOMETRY_ID) {
        shape_of(raw).fill_hit(ray.origin, ray.direction, raw, hit);
    } else {
        const InstancedShape& placed = *entries_[raw.instance].placed[raw.geometry];
        const Placement& place = placed.placement();
        shape_of(raw).fill_hit(Vec3(place.local_point(Vec3d(ray.origin))),
                               Vec3(place.local_vector(Vec3d(ray.direction))), raw, hit);
        placed.to_world(hit);
    }
    hit.t = raw.t;
}

}  // namespace mote::core::embree
