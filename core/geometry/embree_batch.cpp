// Rays go to Embree in packets. The corners of the triangles that they hit are gathered one by one; points
// and their rounding errors follow by vector instructions.
#include "core/geometry/embree_batch.h"

#include <algorithm>

#include "core/math/vectorize.h"

namespace mote::core::embree {
namespace {

/// Corners of the triangles that the rays of a packet hit.
template <int width>
struct Corners {
    VecLanes<width> a, b, c;
    alignas(64) float plane_error[width] = {};
};

/// Everything of the hits of a packet but those points of meshes that follow from their corners.
template <int width>
void gather(const ShapeScenes& scenes, int first, int count, HitBatch& hits, Corners<width>& corners) {
    for (int i = 0; i < count; ++i) {
        const int k = first + i;
        hits.shape[k] = nullptr;
        if (hits.geometry[k] == RTC_INVALID_GEOMETRY_ID) continue;
        const RawHit raw = raw_hit(hits, k);
        const TriangleMesh* mesh =
            raw.instance == RTC_INVALID_GEOMETRY_ID ? scenes.shape_of(raw).mesh() : nullptr;
        if (mesh) {
            const TriangleMesh::Triangle& triangle = mesh->triangle(raw.primitive);
            hits.shape[k] = mesh;
            corners.a.set(i, triangle.corners[0]), corners.b.set(i, triangle.corners[1]);
            corners.c.set(i, triangle.corners[2]), corners.plane_error[i] = triangle.plane_error;
            hits.geometric_normal.set(k, triangle.normal);
            hits.shading_normal.set(k, mesh->shading_normal(raw.primitive, raw.u, raw.v, triangle.normal));
        }
    }
}

/// Points on meshes, as TriangleMesh::fill_hit() has them.
template <int width>
void find_points(const Corners<width>& corners, int first, HitBatch& hits) {
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < width; ++i) {
        const int k = first + i;
        const Vec3 a = corners.a.get(i), normal = hits.geometric_normal.get(k);
        const Vec3 point = triangle_point(a, corners.b.get(i), corners.c.get(i), hits.u[k], hits.v[k]);
        hits.position.set(k, point);
        hits.error[k] = quantization_error(point, normal) + corners.plane_error[i];
    }
}

/// Hits of all other shapes.
void fill_others(const ShapeScenes& scenes, const RayBatch& rays, int first, int count, HitBatch& hits) {
    for (int k = first; k < first + count; ++k) {
        if (hits.shape[k] || hits.geometry[k] == RTC_INVALID_GEOMETRY_ID) continue;
        SurfaceHit hit;
        scenes.fill_hit(rays.ray(k), raw_hit(hits, k), hit);
        hits.shape[k] = hit.shape, hits.error[k] = hit.error;
        hits.position.set(k, hit.position), hits.geometric_normal.set(k, hit.geometric_normal);
        hits.shading_normal.set(k, hit.shading.n);
    }
}

template <typename Packet>
void closest_of_packet(const ShapeScenes& scenes, Query& query, const RayBatch& rays, int first,
                       HitBatch& hits) {
    constexpr int width = int(std::size(Packet{}.ray.org_x));
    const int count = std::min(width, rays.count - first);
    alignas(64) int valid[width];
    Packet p;
    const float unit = scenes.unit().per_metre, max_origin = scenes.max_ray_origin();
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < width; ++i) {
        const Vec3 o = rays.origin.get(first + i), d = rays.direction.get(first + i);
        const float t_min = rays.t_min[first + i], t_max = rays.t_max[first + i];
        valid[i] = -int(i < count) & -int(traceable(o, d, t_min, t_max, max_origin));
        p.ray.org_x[i] = unit * o.x, p.ray.org_y[i] = unit * o.y, p.ray.org_z[i] = unit * o.z;
        p.ray.dir_x[i] = unit * d.x, p.ray.dir_y[i] = unit * d.y, p.ray.dir_z[i] = unit * d.z;
        p.ray.tnear[i] = t_min, p.ray.tfar[i] = t_max_of_lane(valid[i], t_max);
        p.ray.time[i] = 0.0f, p.ray.mask[i] = 0xffffffffu, p.ray.id[i] = unsigned(i), p.ray.flags[i] = 0;
        p.hit.geomID[i] = p.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        p.hit.primID[i] = 0, p.hit.u[i] = p.hit.v[i] = 0.0f;
    }
    intersect(valid, scenes.surfaces(), query, p);
    std::copy_n(p.ray.tfar, width, hits.t + first);
    std::copy_n(p.hit.u, width, hits.u + first), std::copy_n(p.hit.v, width, hits.v + first);
    std::copy_n(p.hit.geomID, width, hits.geometry + first);
    std::copy_n(p.hit.primID, width, hits.primitive + first);
    std::copy_n(p.hit.instID[0], width, hits.instance + first);
    Corners<width> corners;
    gather(scenes, first, count, hits, corners);
    find_points(corners, first, hits);
    fill_others(scenes, rays, first, count, hits);
}

}  // namespace

void closest(const ShapeScenes& scenes, const RayBatch& rays, bool coherent, HitBatch& hits) {
    static_assert(RayBatch::capacity % 16 == 0);
    Query query;
    if (coherent) use_coherent_rays(query);
    for (int first = 0; first < rays.count;)
        if (coherent && rays.count - first > 8)
            closest_of_packet<RTCRayHit16>(scenes, query, rays, first, hits), first += 16;
        else
            closest_of_packet<RTCRayHit8>(scenes, query, rays, first, hits), first += 8;
}

}  // namespace mote::core::embree
