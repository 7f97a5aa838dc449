#include "experiments/benchmarks/ray_log.h"

// What the linker's --wrap makes of the names: __real_ is Embree's own function.
#if RTC_VERSION_MAJOR >= 4
using Intersect = RTCIntersectArguments;
using Occluded = RTCOccludedArguments;
extern "C" {
void __real_rtcIntersect1(RTCScene scene, RTCRayHit* ray, Intersect* arguments);
void __real_rtcOccluded1(RTCScene scene, RTCRay* ray, Occluded* arguments);
void __real_rtcOccluded16(const int* valid, RTCScene scene, RTCRay16* rays, Occluded* arguments);
}
#else
using Intersect = RTCIntersectContext;
using Occluded = RTCIntersectContext;
extern "C" {
void __real_rtcIntersect1(RTCScene scene, Intersect* context, RTCRayHit* ray);
void __real_rtcOccluded1(RTCScene scene, Occluded* context, RTCRay* ray);
void __real_rtcOccluded16(const int* valid, RTCScene scene, Occluded* context, RTCRay16* rays);
void __real_rtcOccludedNM(RTCScene scene, Occluded* context, RTCRayN* rays, unsigned n, unsigned m,
                          std::size_t stride);
}
#endif

namespace mote::benchmarks {
namespace {

// A wrapper is called by name and takes no argument of ours: the open log must be found from nowhere.
RayLog*& open_log() {
    static RayLog* log = nullptr;
    return log;
}

void log_ray(RTCScene scene, const RTCRay& ray, bool occlusion) {
    if (RayLog* log = open_log()) log->rays.push_back({ray, scene, occlusion});
}
void log_packet(const int* valid, RTCScene scene, const RTCRay16& rays) {
    if (RayLog* log = open_log()) {
        LoggedPacket& packet = log->packets.emplace_back();
        packet.rays = rays, packet.scene = scene;
        for (int lane = 0; lane < 16; ++lane) packet.valid[lane] = valid[lane];
    }
}

}  // namespace

RayLog::RayLog() { open_log() = this; }
void RayLog::close() {
    if (open_log() == this) open_log() = nullptr;
}

#if RTC_VERSION_MAJOR >= 4
void bare_intersect(RTCScene scene, RTCRayHit& ray) { __real_rtcIntersect1(scene, &ray, nullptr); }
void bare_occluded(RTCScene scene, RTCRay& ray) { __real_rtcOccluded1(scene, &ray, nullptr); }
void bare_occluded(const int* valid, RTCScene scene, RTCRay16& rays, bool coherent) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    __real_rtcOccluded16(valid, scene, &rays, &arguments);
}
#else
void bare_intersect(RTCScene scene, RTCRayHit& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    __real_rtcIntersect1(scene, &context, &ray);
}
void bare_occluded(RTCScene scene, RTCRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    __real_rtcOccluded1(scene, &context, &ray);
}
void bare_occluded(const int* valid, RTCScene scene, RTCRay16& rays, bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    __real_rtcOccluded16(valid, scene, &context, &rays);
}
void bare_occluded_stream(RTCScene scene, RTCRay16* packets, unsigned count, std::size_t stride,
                          bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    __real_rtcOccludedNM(scene, &context, reinterpret_cast<RTCRayN*>(packets), 16, count, stride);
}
#endif

}  // namespace mote::benchmarks

extern "C" {
#if RTC_VERSION_MAJOR >= 4
void __wrap_rtcIntersect1(RTCScene scene, RTCRayHit* ray, Intersect* arguments) {
    mote::benchmarks::log_ray(scene, ray->ray, false);
    __real_rtcIntersect1(scene, ray, arguments);
}
void __wrap_rtcOccluded1(RTCScene scene, RTCRay* ray, Occluded* arguments) {
    mote::benchmarks::log_ray(scene, *ray, true);
    __real_rtcOccluded1(scene, ray, arguments);
}
void __wrap_rtcOccluded16(const int* valid, RTCScene scene, RTCRay16* rays, Occluded* arguments) {
    mote::benchmarks::log_packet(valid, scene, *rays);
    __real_rtcOccluded16(valid, scene, rays, arguments);
}
#else
void __wrap_rtcIntersect1(RTCScene scene, Intersect* context, RTCRayHit* ray) {
    mote::benchmarks::log_ray(scene, ray->ray, false);
    __real_rtcIntersect1(scene, context, ray);
}
void __wrap_rtcOccluded1(RTCScene scene, Occluded* context, RTCRay* ray) {
    mote::benchmarks::log_ray(scene, *ray, true);
    __real_rtcOccluded1(scene, context, ray);
}
void __wrap_rtcOccluded16(const int* valid, RTCScene scene, Occluded* context, RTCRay16* rays) {
    mote::benchmarks::log_packet(valid, scene, *rays);
    __real_rtcOccluded16(valid, scene, context, rays);
}
void __wrap_rtcOccludedNM(RTCScene scene, Occluded* context, RTCRayN* rays, unsigned n, unsigned m,
                          std::size_t stride) {
    for (unsigned i = 0; i < m && n == 16; ++i) {
        const auto& packet =
            *reinterpret_cast<const RTCRay16*>(reinterpret_cast<const char*>(rays) + i * stride);
        int valid[16];
        for (int lane = 0; lane < 16; ++lane) valid[lane] = packet.tfar[lane] >= packet.tnear[lane] ? -1 : 0;
        mote::benchmarks::log_packet(valid, scene, packet);
    }
    __real_rtcOccludedNM(scene, context, rays, n, m, stride);
}
#endif
}
