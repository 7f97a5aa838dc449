// The callbacks work for any packet width N: Embree calls them with 1, 4, 8 or 16 lanes, or a stream.
#include "core/geometry/embree_shapes.h"

#include <new>
#include <stdexcept>

namespace mote::core::embree {
namespace {

const AnalyticGeometry& geometry_of(void* user_pointer) {
    return *static_cast<const AnalyticGeometry*>(user_pointer);
}

Vec3 origin_of(RTCRayN* ray, unsigned n, unsigned lane) {
    return {RTCRayN_org_x(ray, n, lane), RTCRayN_org_y(ray, n, lane), RTCRayN_org_z(ray, n, lane)};
}
Vec3 direction_of(RTCRayN* ray, unsigned n, unsigned lane) {
    return {RTCRayN_dir_x(ray, n, lane), RTCRayN_dir_y(ray, n, lane), RTCRayN_dir_z(ray, n, lane)};
}

void bound(const RTCBoundsFunctionArguments* arguments) {
    const AnalyticGeometry& geometry = geometry_of(arguments->geometryUserPtr);
    Bounds3 box = geometry.shape.bounds();
    box.lower *= geometry.unit.per_metre, box.upper *= geometry.unit.per_metre;
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = box.lower.x, out.lower_y = box.lower.y, out.lower_z = box.lower.z;
    out.upper_x = box.upper.x, out.upper_y = box.upper.y, out.upper_z = box.upper.z;
}

void intersect_shape(const RTCIntersectFunctionNArguments* arguments) {
    const auto& [shape, unit] = geometry_of(arguments->geometryUserPtr);
    const float metres = 1.0f / unit.per_metre;
    const unsigned n = arguments->N;
    RTCRayN* ray = RTCRayHitN_RayN(arguments->rayhit, n);
    RTCHitN* hit = RTCRayHitN_HitN(arguments->rayhit, n);
    auto* query = reinterpret_cast<Query*>(arguments->context);
    auto* collected = query->collected;
    const unsigned instance = query->base.instID[0];
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        const Vec3 origin = metres * origin_of(ray, n, lane), direction = metres * direction_of(ray, n, lane);
        const float t_min = RTCRayN_tnear(ray, n, lane);
        float& t_max = RTCRayN_tfar(ray, n, lane);
        if (collected) {
            const LineHits hits = shape.line_hits(origin, direction);
            for (int i = 0; i < hits.count; ++i)
                if (const auto t = float(hits.t[std::size_t(i)]); t > t_min && t < t_max)
                    collected->push_back({t, 0.0f, 0.0f, arguments->geomID, arguments->primID, instance});
        } else if (const auto t = shape.intersect(origin, direction, t_min, t_max)) {
            t_max = *t;
            RTCHitN_geomID(hit, n, lane) = arguments->geomID;
            RTCHitN_primID(hit, n, lane) = arguments->primID;
            RTCHitN_instID(hit, n, lane, 0) = instance;
            RTCHitN_u(hit, n, lane) = RTCHitN_v(hit, n, lane) = 0.0f;
            // The normal is computed in fill_hit; Embree only needs it to be set.
            RTCHitN_Ng_x(hit, n, lane) = RTCHitN_Ng_y(hit, n, lane) = 0.0f;
            RTCHitN_Ng_z(hit, n, lane) = 1.0f;
        }
    }
}

void occlude_shape(const RTCOccludedFunctionNArguments* arguments) {
    const auto& [shape, unit] = geometry_of(arguments->geometryUserPtr);
    const float metres = 1.0f / unit.per_metre;
    const unsigned n = arguments->N;
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        RTCRayN* ray = arguments->ray;
        float& t_max = RTCRayN_tfar(ray, n, lane);
        if (shape.intersect(metres * origin_of(ray, n, lane), metres * direction_of(ray, n, lane),
                            RTCRayN_tnear(ray, n, lane), t_max))
            t_max = -infinity;
    }
}

/// Vertices as they are where the unit is the metre, else a copy in that unit.
template <typename Vertex>
void set_vertices(RTCGeometry geometry, RTCFormat format, const std::vector<Vertex>& vertices,
                  TracingUnit unit) {
    if (unit.per_metre == 1.0f) {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, format, vertices.data(), 0,
                                   sizeof(Vertex), vertices.size());
        return;
    }
    auto* copy = static_cast<Vertex*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, format,
                                                              sizeof(Vertex), vertices.size()));
    if (!copy) throw std::bad_alloc();
    for (const Vertex& vertex : vertices) *copy++ = unit.per_metre * vertex;
}

Geometry make_mesh_geometry(RTCDevice device, const TriangleMesh& mesh, TracingUnit unit) {
    Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    const MeshData& data = mesh.data();
    set_vertices(geometry.get(), RTC_FORMAT_FLOAT3, data.positions, unit);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               data.triangles.data(), 0, sizeof(data.triangles[0]), data.triangles.size());
    rtcCommitGeometry(geometry.get());
    return geometry;
}

Geometry make_analytic_geometry(RTCDevice device, AnalyticGeometry& shape) {
    Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), 1);
    rtcSetGeometryUserData(geometry.get(), &shape);
    rtcSetGeometryBoundsFunction(geometry.get(), bound, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), intersect_shape);
    rtcSetGeometryOccludedFunction(geometry.get(), occlude_shape);
    rtcCommitGeometry(geometry.get());
    return geometry;
}

/// Some builds of Embree meet curves from inside, Mitsuba's does not: filter that lets such hits pass.
void pass_from_inside(const RTCFilterFunctionNArguments* arguments) {
    const unsigned n = arguments->N;
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        const Vec3 direction = direction_of(arguments->ray, n, lane);
        const Vec3 normal(RTCHitN_Ng_x(arguments->hit, n, lane), RTCHitN_Ng_y(arguments->hit, n, lane),
                          RTCHitN_Ng_z(arguments->hit, n, lane));
        if (glm::dot(direction, normal) > 0.0f) arguments->valid[lane] = 0;
    }
}

Geometry make_curve_geometry(RTCDevice device, const Curves& curves, TracingUnit unit) {
    const CurveData& data = curves.data();
    Geometry geometry(rtcNewGeometry(device, data.basis == CurveBasis::linear
                                                 ? RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE
                                                 : RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE));
    set_vertices(geometry.get(), RTC_FORMAT_FLOAT4, data.points, unit);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                               data.segments.data(), 0, sizeof(data.segments[0]), data.segments.size());
    rtcSetGeometryIntersectFilterFunction(geometry.get(), pass_from_inside);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), pass_from_inside);
    rtcCommitGeometry(geometry.get());
    return geometry;
}

}  // namespace

TracedShape::TracedShape(const Shape& shape, TracingUnit unit)
    : shape_(&shape),
      mesh_(dynamic_cast<const TriangleMesh*>(&shape)),
      curves_(dynamic_cast<const Curves*>(&shape)),
      unit_(unit) {
    if (const auto* analytic = dynamic_cast<const AnalyticShape*>(&shape))
        analytic_ = std::make_unique<AnalyticGeometry>(AnalyticGeometry{*analytic, unit});
    if (!mesh_ && !analytic_ && !curves_) throw std::logic_error("a shape of an unknown kind");
}

Geometry TracedShape::make_geometry(RTCDevice device) const {
    return mesh_       ? make_mesh_geometry(device, *mesh_, unit_)
           : analytic_ ? make_analytic_geometry(device, *analytic_)
                       : make_curve_geometry(device, *curves_, unit_);
}

void TracedShape::fill_hit(const Vec3& origin, const Vec3& direction, const RawHit& raw,
                           SurfaceHit& hit) const {
    if (mesh_)
        mesh_->fill_hit(raw.primitive, raw.u, raw.v, hit);
    else if (analytic_)
        analytic_->shape.fill_hit(origin, direction, raw.t, hit);
    else
        curves_->fill_hit(raw.primitive, raw.u, Vec3d(origin) + double(raw.t) * Vec3d(direction), hit);
}

void collect_hits(const RTCFilterFunctionNArguments* arguments) {
    auto& collected = *reinterpret_cast<Query*>(arguments->context)->collected;
    const unsigned n = arguments->N;
    for (unsigned lane = 0; lane < n; ++lane) {
        if (arguments->valid[lane] == 0) continue;
        collected.push_back({RTCRayN_tfar(arguments->ray, n, lane), RTCHitN_u(arguments->hit, n, lane),
                             RTCHitN_v(arguments->hit, n, lane), RTCHitN_geomID(arguments->hit, n, lane),
                             RTCHitN_primID(arguments->hit, n, lane),
                             RTCHitN_instID(arguments->hit, n, lane, 0)});
        arguments->valid[lane] = 0;
    }
}

}  // namespace mote::core::embree
