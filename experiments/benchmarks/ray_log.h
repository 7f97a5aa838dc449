// Writes down the rays that mote gives to Embree, so that bare Embree can trace the very same ones.
//
// The linker routes rtcIntersect1, rtcOccluded1, rtcOccluded16 and (Embree 3) rtcOccluded1M of the whole
// program through wrappers (--wrap, see CMakeLists.txt) that log while a RayLog is open and pass the call on.
#pragma once

#include <vector>

#include "core/geometry/embree_api.h"

namespace mote::benchmarks {

struct LoggedRay {
    RTCRay ray;
    RTCScene scene;
    bool occlusion;
};
/// Logs from construction to close(). One at a time, on one thread.
class RayLog {
  public:
    RayLog();
    ~RayLog() { close(); }
    RayLog(const RayLog&) = delete;
    RayLog& operator=(const RayLog&) = delete;
    void close();

    std::vector<LoggedRay> rays;  ///< in the order of the calls; packets and streams lane by lane
};

/// Embree itself, past the wrappers.
void bare_intersect(RTCScene scene, RTCRayHit& ray);
void bare_occluded(RTCScene scene, RTCRay& ray);
/// `coherent` is Embree's hint.
void bare_occluded(const int* valid, RTCScene scene, RTCRay16& rays, bool coherent);
#if RTC_VERSION_MAJOR < 4
void bare_occluded_stream(RTCScene scene, RTCRay* rays, unsigned count, bool coherent);
#endif

/// Seconds that Embree takes for logged rays, one by one and in their order: nothing else is known to a path
/// tracer in time.
double trace_bare(const std::vector<LoggedRay>& rays);

}  // namespace mote::benchmarks
