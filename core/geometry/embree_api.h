// Embree 3 and 4 under one set of calls: what differs is where flags, filters and user data travel.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace mote::core::embree {

template <auto release>
struct Releaser {
    template <typename Handle>
    void operator()(Handle* handle) const {
        release(handle);
    }
};
using Device = std::unique_ptr<RTCDeviceTy, Releaser<rtcReleaseDevice>>;
using Scene = std::unique_ptr<RTCSceneTy, Releaser<rtcReleaseScene>>;
using Geometry = std::unique_ptr<RTCGeometryTy, Releaser<rtcReleaseGeometry>>;

/// One hit of many along a ray.
struct RawHit {
    float t, u, v;
    unsigned geometry, primitive;
    unsigned instance;  ///< RTC_INVALID_GEOMETRY_ID where the geometry is none of an instance
};

/// The hits along a ray in the order in which Embree finds them; takes memory only for more than a few.
class RawHits {
  public:
    void push_back(const RawHit& hit) {
        if (count_ == first_.size()) more_.assign(first_.begin(), first_.end());
        if (count_ >= first_.size())
            more_.push_back(hit);
        else
            first_[count_] = hit;
        ++count_;
    }
    std::span<RawHit> all() { return {count_ > first_.size() ? more_.data() : first_.data(), count_}; }

  private:
    std::array<RawHit, 32> first_;
    std::vector<RawHit> more_;
    std::size_t count_ = 0;
};

/// Context of a query for the callbacks. `collected` is null unless all hits are requested. `base`
/// comes first: the callbacks get its address.
#if RTC_VERSION_MAJOR >= 4
struct Query {
    RTCRayQueryContext base;
    RawHits* collected = nullptr;
    RTCRayQueryFlags flags = RTC_RAY_QUERY_FLAG_NONE;
    Query() { rtcInitRayQueryContext(&base); }
};
/// The rays of a packet are neighbours and go the same way.
inline void use_coherent_rays(Query& query) { query.flags = RTC_RAY_QUERY_FLAG_COHERENT; }
inline constexpr auto filter_scene_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
inline constexpr bool has_streams = false;  // Embree 4 has none

inline void intersect(RTCScene scene, Query& query, RTCRayHit& ray) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.base;
    rtcIntersect1(scene, &ray, &arguments);
}
inline void intersect_filtered(RTCScene scene, Query& query, RTCRayHit& ray, RTCFilterFunctionN filter) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.base;
    arguments.filter = filter;
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    rtcIntersect1(scene, &ray, &arguments);
}
inline void occluded(RTCScene scene, Query& query, RTCRay& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &query.base;
    rtcOccluded1(scene, &ray, &arguments);
}
inline void occluded(const int* valid, RTCScene scene, Query& query, RTCRay16& rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &query.base, arguments.flags = query.flags;
    rtcOccluded16(valid, scene, &rays, &arguments);
}
inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit16& rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.base, arguments.flags = query.flags;
    rtcIntersect16(valid, scene, &rays, &arguments);
}
inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit8& rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.base, arguments.flags = query.flags;
    rtcIntersect8(valid, scene, &rays, &arguments);
}
inline void occluded_stream(RTCScene scene, Query& query, RTCRay* rays, unsigned count) {
    for (unsigned i = 0; i < count; ++i) occluded(scene, query, rays[i]);
}
#else
struct Query {
    RTCIntersectContext base;
    RawHits* collected = nullptr;
    Query() { rtcInitIntersectContext(&base); }  // with the incoherent flag, the faster one for shadow rays
};
/// The rays of a packet are neighbours and go the same way.
inline void use_coherent_rays(Query& query) { query.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT; }
inline constexpr auto filter_scene_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
inline constexpr bool has_streams = true;

inline void intersect(RTCScene scene, Query& query, RTCRayHit& ray) {
    rtcIntersect1(scene, &query.base, &ray);
}
inline void intersect_filtered(RTCScene scene, Query& query, RTCRayHit& ray, RTCFilterFunctionN filter) {
    query.base.filter = filter;
    rtcIntersect1(scene, &query.base, &ray);
}
inline void occluded(RTCScene scene, Query& query, RTCRay& ray) { rtcOccluded1(scene, &query.base, &ray); }
inline void occluded(const int* valid, RTCScene scene, Query& query, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &query.base, &rays);
}
inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &query.base, &rays);
}
inline void intersect(const int* valid, RTCScene scene, Query& query, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &query.base, &rays);
}
inline void occluded_stream(RTCScene scene, Query& query, RTCRay* rays, unsigned count) {
    rtcOccluded1M(scene, &query.base, rays, count, sizeof(RTCRay));
}
#endif

}  // namespace mote::core::embree
