#include "experiments/benchmarks/ray_log.h"

#include "experiments/benchmarks/turns.h"

// Names made by the linker's --wrap: __real_ is Embree's own function.
#if RTC_VERSION_MAJOR >= 4
using Intersect = RTCIntersectArguments;
using Occluded = RTCOccludedArguments;
extern "C" {
void __real_rtcIntersect1(RTCScene scene, RTCRayHit* ray, Intersect* arguments);
void __real_rtcIntersect8(const int* valid, RTCScene scene, RTCRayHit8* rays, Intersect* arguments);
void __real_rtcIntersect16(const int* valid, RTCScene scene, RTCRayHit16* rays, Intersect* arguments);
void __real_rtcOccluded1(RTCScene scene, RTCRay* ray, Occluded* arguments);
void __real_rtcOccluded16(const int* valid, RTCScene scene, RTCRay16* rays, Occluded* arguments);
}
#else
using Intersect = RTCIntersectContext;
using Occluded = RTCIntersectContext;
extern "C" {
void __real_rtcIntersect1(RTCScene scene, Intersect* context, RTCRayHit* ray);
void __real_rtcIntersect8(const int* valid, RTCScene scene, Intersect* context, RTCRayHit8* rays);
void __real_rtcIntersect16(const int* valid, RTCScene scene, Intersect* context, RTCRayHit16* rays);
void __real_rtcOccluded1(RTCScene scene, Occluded* context, RTCRay* ray);
void __real_rtcOccluded16(const int* valid, RTCScene scene, Occluded* context, RTCRay16* rays);
void __real_rtcOccluded1M(RTCScene scene, Occluded* context, RTCRay* rays, unsigned count,
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
template <typename Packet>
void log_packet(const int* valid, RTCScene scene, const Packet& p, bool occlusion) {
    for (std::size_t i = 0; i < std::size(p.org_x); ++i) {
        if (!valid[i]) continue;
        RTCRay ray{};
        ray.org_x = p.org_x[i], ray.org_y = p.org_y[i], ray.org_z = p.org_z[i], ray.tnear = p.tnear[i];
        ray.dir_x = p.dir_x[i], ray.dir_y = p.dir_y[i], ray.dir_z = p.dir_z[i], ray.tfar = p.tfar[i];
        ray.time = p.time[i], ray.mask = p.mask[i];
        log_ray(scene, ray, occlusion);
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
void bare_occluded_stream(RTCScene scene, RTCRay* rays, unsigned count, bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    __real_rtcOccluded1M(scene, &context, rays, count, sizeof(RTCRay));
}
#endif

double trace_bare(const std::vector<LoggedRay>& rays) {
    float sum = 0.0f;
    const double seconds = seconds_of([&] {
        for (const LoggedRay& logged : rays) {
            if (logged.occlusion) {
                RTCRay ray = logged.ray;
                bare_occluded(logged.scene, ray);
                sum += ray.tfar;
            } else {
                RTCRayHit query;
                query.ray = logged.ray;
                query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
                bare_intersect(logged.scene, query);
                sum += query.ray.tfar;
            }
        }
    });
    benchmark::DoNotOptimize(sum);
    return seconds;
}

}  // namespace mote::benchmarks

extern "C" {
#if RTC_VERSION_MAJOR >= 4
void __wrap_rtcIntersect1(RTCScene scene, RTCRayHit* ray, Intersect* arguments) {
    mote::benchmarks::log_ray(scene, ray->ray, false);
    __real_rtcIntersect1(scene, ray, arguments);
}
void __wrap_rtcIntersect8(const int* valid, RTCScene scene, RTCRayHit8* rays, Intersect* arguments) {
    mote::benchmarks::log_packet(valid, scene, rays->ray, false);
    __real_rtcIntersect8(valid, scene, rays, arguments);
}
void __wrap_rtcIntersect16(const int* valid, RTCScene scene, RTCRayHit16* rays, Intersect* arguments) {
    mote::benchmarks::log_packet(valid, scene, rays->ray, false);
    __real_rtcIntersect16(valid, scene, rays, arguments);
}
void __wrap_rtcOccluded1(RTCScene scene, RTCRay* ray, Occluded* arguments) {
    mote::benchmarks::log_ray(scene, *ray, true);
    __real_rtcOccluded1(scene, ray, arguments);
}
void __wrap_rtcOccluded16(const int* valid, RTCScene scene, RTCRay16* rays, Occluded* arguments) {
    mote::benchmarks::log_packet(valid, scene, *rays, true);
    __real_rtcOccluded16(valid, scene, rays, arguments);
}
#else
void __wrap_rtcIntersect1(RTCScene scene, Intersect* context, RTCRayHit* ray) {
    mote::benchmarks::log_ray(scene, ray->ray, false);
    __real_rtcIntersect1(scene, context, ray);
}
void __wrap_rtcIntersect8(const int* valid, RTCScene scene, Intersect* context, RTCRayHit8* rays) {
    mote::benchmarks::log_packet(valid, scene, rays->ray, false);
    __real_rtcIntersect8(valid, scene, context, rays);
}
void __wrap_rtcIntersect16(const int* valid, RTCScene scene, Intersect* context, RTCRayHit16* rays) {
    mote::benchmarks::log_packet(valid, scene, rays->ray, false);
    __real_rtcIntersect16(valid, scene, context, rays);
}
void __wrap_rtcOccluded1(RTCScene scene, Occluded* context, RTCRay* ray) {
    mote::benchmarks::log_ray(scene, *ray, true);
    __real_rtcOccluded1(scene, context, ray);
}
void __wrap_rtcOccluded16(const int* valid, RTCScene scene, Occluded* context, RTCRay16* rays) {
    mote::benchmarks::log_packet(valid, scene, *rays, true);
    __real_rtcOccluded16(valid, scene, context, rays);
}
void __wrap_rtcOccluded1M(RTCScene scene, Occluded* context, RTCRay* rays, unsigned count,
                          std::size_t stride) {
    for (unsigned i = 0; i < count; ++i)
        mote::benchmarks::log_ray(
            scene, *reinterpret_cast<const RTCRay*>(reinterpret_cast<const char*>(rays) + i * stride), true);
    __real_rtcOccluded1M(scene, context, rays, count, stride);
}
#endif
}
