// Boxes are user geometry: Embree queries their bounds, and calls back for each that a ray may pass. The
// callback never reports a hit, so that rays continue to the end.
#include "core/geometry/box_hierarchy.h"

#include <atomic>
#include <cstddef>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/geometry/embree_api.h"
#include "core/geometry/mesh_checks.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

bool count_bytes(void* user_pointer, ssize_t bytes, bool) {
    static_cast<std::atomic<std::int64_t>*>(user_pointer)->fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

void bounds_of_box(const RTCBoundsFunctionArguments* arguments) {
    const Bounds3& box = static_cast<const Bounds3*>(arguments->geometryUserPtr)[arguments->primID];
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = box.lower.x, out.lower_y = box.lower.y, out.lower_z = box.lower.z;
    out.upper_x = box.upper.x, out.upper_y = box.upper.y, out.upper_z = box.upper.z;
}

struct BoxQuery {
    embree::Query query;  // first: the callback gets its address
    void (*visitor)(const void*, std::uint32_t, std::uint32_t);
    const void* visit;
};

void visit_box(const RTCOccludedFunctionNArguments* arguments) {
    const auto& query = *reinterpret_cast<const BoxQuery*>(arguments->context);
    std::uint32_t lanes = 0;
    for (unsigned lane = 0; lane < arguments->N; ++lane)
        lanes |= std::uint32_t(arguments->valid[lane] != 0) << RTCRayN_id(arguments->ray, arguments->N, lane);
    query.visitor(query.visit, arguments->primID, lanes);
}

void intersect_nothing(const RTCIntersectFunctionNArguments*) {}

}  // namespace

struct BoxHierarchy::Implementation {
    std::atomic<std::int64_t> memory{0};  // outlives the device
    embree::Device device{rtcNewDevice(nullptr)};
    embree::Scene scene;
};

BoxHierarchy::BoxHierarchy(std::span<const Bounds3> boxes) : impl_(std::make_unique<Implementation>()) {
    for (const Bounds3& box : boxes)
        if (box.empty() || !(max_component(glm::max(-box.lower, box.upper)) < largest_coordinate))
            throw InputError("a box is empty, not finite, or beyond 1e18");
    if (!impl_->device) throw std::runtime_error("Embree: no device");
    rtcSetDeviceMemoryMonitorFunction(impl_->device.get(), count_bytes, &impl_->memory);
    impl_->scene.reset(rtcNewScene(impl_->device.get()));
    rtcSetSceneFlags(impl_->scene.get(), RTC_SCENE_FLAG_ROBUST);
    const embree::Geometry geometry(rtcNewGeometry(impl_->device.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), unsigned(boxes.size()));
    rtcSetGeometryUserData(geometry.get(), const_cast<Bounds3*>(boxes.data()));
    rtcSetGeometryBoundsFunction(geometry.get(), bounds_of_box, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), intersect_nothing);
    rtcSetGeometryOccludedFunction(geometry.get(), visit_box);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(impl_->scene.get(), geometry.get());
    rtcCommitScene(impl_->scene.get());
    const RTCError error = rtcGetDeviceError(impl_->device.get());
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error("Embree: building boxes failed with error " + std::to_string(int(error)));
}

BoxHierarchy::~BoxHierarchy() = default;

std::size_t BoxHierarchy::memory_bytes() const {
    return std::size_t(std::max<std::int64_t>(0, impl_->memory));
}

void BoxHierarchy::visit_boxes(const ShadowPacket& packet, Visitor visitor, const void* visit) const {
    static_assert(sizeof(ShadowPacket) == sizeof(RTCRay16) && alignof(ShadowPacket) == alignof(RTCRay16) &&
                  offsetof(ShadowPacket, id) == offsetof(RTCRay16, id));
    BoxQuery query{{}, visitor, visit};
    embree::use_coherent_rays(query.query);
    alignas(64) int valid[ShadowPacket::width];
    for (int lane = 0; lane < ShadowPacket::width; ++lane)
        valid[lane] = packet.t_max[lane] >= packet.t_min[lane] ? -1 : 0;
    RTCRay16 rays;
    std::memcpy(&rays, &packet, sizeof(rays));
    embree::occluded(valid, impl_->scene.get(), query.query, rays);
}

void BoxHierarchy::visit_boxes(const Ray& ray, Visitor visitor, const void* visit) const {
    BoxQuery query{{}, visitor, visit};
    RTCRay r{};
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z, r.tnear = ray.t_min;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z, r.tfar = ray.t_max;
    r.mask = 0xffffffffu;
    embree::occluded(impl_->scene.get(), query.query, r);
}

}  // namespace mote::core
