#include "core/geometry/ray_facing_discs.h"

#include <algorithm>
#include <atomic>
#include <new>
#include <stdexcept>
#include <string>

#include "core/geometry/embree_shapes.h"

namespace mote::core {

struct RayFacingDiscs::Implementation {
    std::atomic<std::int64_t> memory{0};  // outlives the device
    std::vector<Disc> discs;              // read by Embree
    float largest_radius = 0.0f;
    embree::Device device;
    embree::Scene scene;

    void open() {
        if (device) return;
        device.reset(rtcNewDevice(nullptr));
        if (!device) throw std::runtime_error("Embree: no device");
        rtcSetDeviceMemoryMonitorFunction(
            device.get(),
            [](void* counter, ssize_t bytes, bool) {
                static_cast<std::atomic<std::int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
                return true;
            },
            &memory);
    }
    void check() const {
        const RTCError error = rtcGetDeviceError(device.get());
        if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
        if (error != RTC_ERROR_NONE)
            throw std::runtime_error("Embree: building discs failed with error " +
                                     std::to_string(int(error)));
    }
};

RayFacingDiscs::RayFacingDiscs() : impl_(std::make_unique<Implementation>()) {}
RayFacingDiscs::~RayFacingDiscs() = default;
RayFacingDiscs::RayFacingDiscs(RayFacingDiscs&&) noexcept = default;
RayFacingDiscs& RayFacingDiscs::operator=(RayFacingDiscs&&) noexcept = default;

std::span<const RayFacingDiscs::Disc> RayFacingDiscs::discs() const { return impl_->discs; }

void RayFacingDiscs::build(std::vector<Disc> discs) {
    static_assert(sizeof(Disc) == 4 * sizeof(float), "Embree reads x, y, z, radius");
    impl_->open();
    impl_->scene.reset();
    impl_->discs = std::move(discs);
    impl_->largest_radius = 0.0f;
    for (const Disc& disc : impl_->discs)
        impl_->largest_radius = std::max(impl_->largest_radius, disc.radius);
    if (impl_->discs.empty()) return;
    impl_->scene.reset(rtcNewScene(impl_->device.get()));
    rtcSetSceneFlags(impl_->scene.get(), RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | embree::filter_scene_flag));
    const embree::Geometry geometry(rtcNewGeometry(impl_->device.get(), RTC_GEOMETRY_TYPE_DISC_POINT));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                               impl_->discs.data(), 0, sizeof(Disc), impl_->discs.size());
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(impl_->scene.get(), geometry.get());
    rtcCommitScene(impl_->scene.get());
    impl_->check();
}

void RayFacingDiscs::hits(const Ray& ray, std::vector<Hit>& hits) const {
    hits.clear();
    if (!impl_->scene || !is_finite(ray.origin) || !is_finite(ray.direction) || !(ray.t_min < ray.t_max))
        return;
    // Embree leaves out discs nearer than twice their radius, for the sake of shadow rays that start on them:
    // so the ray starts farther back.
    const float back = 2.0f * impl_->largest_radius + 1e-6f * glm::length(ray.origin);
    const Vec3 origin = ray.origin - back * ray.direction;
    RTCRayHit r{};
    r.ray.org_x = origin.x, r.ray.org_y = origin.y, r.ray.org_z = origin.z, r.ray.tnear = ray.t_min + back;
    r.ray.dir_x = ray.direction.x, r.ray.dir_y = ray.direction.y, r.ray.dir_z = ray.direction.z;
    r.ray.tfar = ray.t_max + back, r.ray.mask = 0xffffffffu;
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::RawHits raw;
    embree::Query query;
    query.collected = &raw;
    embree::intersect_filtered(impl_->scene.get(), query, r, embree::collect_hits);
    for (const embree::RawHit& h : raw.all())
        hits.push_back({std::clamp(h.t - back, ray.t_min, ray.t_max), h.primitive});
    std::sort(hits.begin(), hits.end(),
              [](const Hit& a, const Hit& b) { return a.t != b.t ? a.t < b.t : a.index < b.index; });
    const auto same = [](const Hit& a, const Hit& b) {
        return a.index == b.index;
    };  // Embree may report one twice
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
}

std::size_t RayFacingDiscs::memory_bytes() const {
    return impl_->discs.capacity() * sizeof(Disc) + std::size_t(std::max<std::int64_t>(0, impl_->memory));
}

}  // namespace mote::core
