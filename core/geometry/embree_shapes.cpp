// The callbacks work for any packet width N: Embree calls them with 1, 4, 8 or 16 lanes, or a stream.
#include "core/geometry/embree_shapes.h"

namespace mote::core::embree {
namespace {

const AnalyticShape& shape_of(void* user_pointer) { return *static_cast<const AnalyticShape*>(user_pointer); }

Vec3 origin_of(RTCRayN* ray, unsigned n, unsigned lane) {
    return {RTCRayN_org_x(ray, n, lane), RTCRayN_org_y(ray, n, lane), RTCRayN_org_z(ray, n, lane)};
}
Vec3 direction_of(RTCRayN* ray, unsigned n, unsigned lane) {
    return {RTCRayN_dir_x(ray, n, lane), RTCRayN_dir_y(ray, n, lane), RTCRayN_dir_z(ray, n, lane)};
}

void bound(const RTCBoundsFunctionArguments* arguments) {
    const Bounds3 box = shape_of(arguments->geometryUserPtr).bounds();
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = box.lower.x, out.lower_y = box.lower.y, out.lower_z = box.lower.z;
    out.upper_x = box.upper.x, out.upper_y = box.upper.y, out.upper_z = box.upper.z;
}

void intersect_shape(const RTCIntersectFunctionNArguments* arguments) {
    const AnalyticShape& shape = shape_of(arguments->geometryUserPtr);
    const unsigned n = arguments->N;
    RTCRayN* ray = RTCRayHitN_RayN(arguments->rayhit, n);
    RTCHitN* hit = RTCRayHitN_HitN(arguments->rayhit, n);
    auto* collected = reinterpret_cast<Query*>(arguments->context)->collected;
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        const Vec3 origin = origin_of(ray, n, lane), direction = direction_of(ray, n, lane);
        const float t_min = RTCRayN_tnear(ray, n, lane);
        float& t_max = RTCRayN_tfar(ray, n, lane);
        if (collected) {
            const LineHits hits = shape.line_hits(origin, direction);
            for (int i = 0; i < hits.count; ++i)
                if (const auto t = float(hits.t[std::size_t(i)]); t > t_min && t < t_max)
                    collected->push_back({t, 0.0f, 0.0f, arguments->geomID, arguments->primID});
        } else if (const auto t = shape.intersect(origin, direction, t_min, t_max)) {
            t_max = *t;
            RTCHitN_geomID(hit, n, lane) = arguments->geomID;
            RTCHitN_primID(hit, n, lane) = arguments->primID;
            RTCHitN_instID(hit, n, lane, 0) = RTC_INVALID_GEOMETRY_ID;
            RTCHitN_u(hit, n, lane) = RTCHitN_v(hit, n, lane) = 0.0f;
            // The normal is computed in fill_hit; Embree only wants it to be set.
            RTCHitN_Ng_x(hit, n, lane) = RTCHitN_Ng_y(hit, n, lane) = 0.0f;
            RTCHitN_Ng_z(hit, n, lane) = 1.0f;
        }
    }
}

void occlude_shape(const RTCOccludedFunctionNArguments* arguments) {
    const AnalyticShape& shape = shape_of(arguments->geometryUserPtr);
    const unsigned n = arguments->N;
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        RTCRayN* ray = arguments->ray;
        float& t_max = RTCRayN_tfar(ray, n, lane);
        if (shape.intersect(origin_of(ray, n, lane), direction_of(ray, n, lane), RTCRayN_tnear(ray, n, lane),
                            t_max))
            t_max = -infinity;
    }
}

}  // namespace

Geometry make_geometry(RTCDevice device, const TriangleMesh& mesh) {
    Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    const MeshData& data = mesh.data();
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               data.positions.data(), 0, sizeof(Vec3), data.positions.size());
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               data.triangles.data(), 0, sizeof(data.triangles[0]), data.triangles.size());
    rtcCommitGeometry(geometry.get());
    return geometry;
}

Geometry make_geometry(RTCDevice device, const AnalyticShape& shape) {
    Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), 1);
    rtcSetGeometryUserData(geometry.get(), const_cast<AnalyticShape*>(&shape));
    rtcSetGeometryBoundsFunction(geometry.get(), bound, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), intersect_shape);
    rtcSetGeometryOccludedFunction(geometry.get(), occlude_shape);
    rtcCommitGeometry(geometry.get());
    return geometry;
}

void collect_hits(const RTCFilterFunctionNArguments* arguments) {
    auto& collected = *reinterpret_cast<Query*>(arguments->context)->collected;
    const unsigned n = arguments->N;
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        collected.push_back({RTCRayN_tfar(arguments->ray, n, lane), RTCHitN_u(arguments->hit, n, lane),
                             RTCHitN_v(arguments->hit, n, lane), RTCHitN_geomID(arguments->hit, n, lane),
                             RTCHitN_primID(arguments->hit, n, lane)});
        arguments->valid[lane] = 0;
    }
}

}  // namespace mote::core::embree
