// The boundaries along a ray, such that entering and leaving agree.
//
// Each triangle is tested on its own and with a tolerance. A ray that passes the edge of a box at a few
// millionths of its size can therefore meet the face that enters it and miss the face beside it that leaves
// it again, or meet both in the wrong order: it would stay in the medium for ever. So where rounding has
// decided, at edges and where a ray grazes a round shape, a hit counts only if it agrees with what comes
// after it on the same line: one is inside exactly where the next crossing leaves.
//
// A boundary may coincide with a surface, such as a box of fog with the walls of its room, and rounding would
// decide which of them a ray meets first. Everywhere the surface does: a ray that ends within rounding of a
// boundary does not cross it, from whichever side it comes, so that fog reaches up to the wall on the side
// where it is.
#include <algorithm>

#include "core/geometry/instances.h"
#include "core/geometry/triangle_mesh.h"
#include "core/scene/scene.h"

namespace mote::core {
namespace {

double largest(const Vec3d& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

/// Distance of a hit from where it belongs, along the ray and across an edge, at most [m], with coordinates
/// of up to `size`: some units in the last place of them and of the distance, from which the triangle is
/// seen.
double rounding_at(const SurfaceHit& hit, const Vec3& direction, double size) {
    const double cosine = std::fabs(glm::dot(hit.geometric_normal, direction));
    return 1e-6 * (double(hit.t) + size) / std::max(cosine, 1e-5);
}

/// The hit triangle in the world; nothing where the shape has none.
std::optional<std::array<Vec3d, 3>> triangle_of(const SurfaceHit& hit) {
    const auto corners = [&](const TriangleMesh& mesh, const auto& to_world) {
        const MeshData& data = mesh.data();
        const auto& [a, b, c] = data.triangles[hit.primitive];
        return std::array{to_world(Vec3d(data.positions[a])), to_world(Vec3d(data.positions[b])),
                          to_world(Vec3d(data.positions[c]))};
    };
    if (const auto* mesh = dynamic_cast<const TriangleMesh*>(hit.shape))
        return corners(*mesh, [](const Vec3d& p) { return p; });
    const auto* placed = dynamic_cast<const InstancedShape*>(hit.shape);
    if (!placed) return std::nullopt;
    const auto* mesh = dynamic_cast<const TriangleMesh*>(&placed->original());
    if (!mesh) return std::nullopt;
    return corners(*mesh, [&](const Vec3d& p) { return placed->placement().to_world().point(p); });
}

/// True if rounding decides whether the ray hits it there, or in which order.
bool rounding_decides(const SurfaceHit& hit, const Vec3& direction) {
    const auto triangle = triangle_of(hit);
    if (!triangle) return std::fabs(glm::dot(hit.geometric_normal, direction)) < 1e-4f;
    const Vec3d p(hit.position);
    double size = 0.0;
    for (const Vec3d& corner : *triangle) size = std::max(size, largest(corner));
    const double reach = rounding_at(hit, direction, size);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d &a = (*triangle)[i], edge = (*triangle)[(i + 1) % 3] - a;
        const Vec3d across = glm::cross(edge, p - a);  // as long as the edge times the distance from it
        if (glm::dot(across, across) <= reach * reach * glm::dot(edge, edge)) return true;
    }
    return false;
}

bool leaves(const SurfaceHit& hit, const Vec3& direction) {
    return glm::dot(hit.geometric_normal, direction) > 0.0f;
}

/// True if the next crossing of the shape, or that there is none, agrees with this one. `inward`: the shape's
/// normals point inwards, and what is outside of everything counts as inside of it.
bool agrees_with_next(const RayTracer& rays, const Ray& ray, const SurfaceHit& hit, bool inward) {
    const double reach = 4.0 * rounding_at(hit, ray.direction, largest(Vec3d(hit.position)));
    const Ray beyond{ray.origin, ray.direction, float(double(hit.t) + reach), infinity};
    bool inside = inward;
    rays.for_each_hit(beyond, RayTracer::Group::boundaries, [&](const SurfaceHit& next) {
        if (next.shape != hit.shape) return true;
        inside = leaves(next, ray.direction);
        return false;
    });
    return inside != leaves(hit, ray.direction);
}

/// True if the ray ends on the boundary, but for rounding.
bool ends_there(const Ray& ray, const SurfaceHit& hit) {
    return double(ray.t_max) - double(hit.t) <= rounding_at(hit, ray.direction, largest(Vec3d(hit.position)));
}

}  // namespace

void Scene::visit_boundaries(const Ray& ray, BoundaryVisitor visitor, const void* visit) const {
    const auto counts = [&](const SurfaceHit& hit) {
        if (!hit.shape->has_medium_boundary) return true;
        if (!hit.shape->bsdf->traits().pane && ends_there(ray, hit)) return false;
        if (!hit.shape->closed()) return true;
        if (!rounding_decides(hit, ray.direction)) return true;
        const auto boundary = std::find_if(boundaries_.begin(), boundaries_.end(),
                                           [&](const Boundary& b) { return b.shape == hit.shape; });
        return agrees_with_next(*rays_, ray, hit, boundary != boundaries_.end() && boundary->inward);
    };
    rays_->for_each_hit(ray, RayTracer::Group::boundaries,
                        [&](const SurfaceHit& hit) { return !counts(hit) || visitor(visit, hit); });
}

void Scene::boundaries_along(const Ray& ray, std::vector<SurfaceHit>& hits) const {
    hits.clear();
    for_each_boundary(ray, [&](const SurfaceHit& hit) {
        hits.push_back(hit);
        return true;
    });
}

}  // namespace mote::core
