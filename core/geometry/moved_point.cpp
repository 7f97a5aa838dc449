#include "core/geometry/moved_point.h"

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/curves.h"
#include "core/geometry/instances.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::core {

namespace {

// Every case adds up how far the point has moved, so that rounding moves nothing that stands still.

Vec3d moved_with(const Transform& now, const Transform& then, const Vec3d& position) {
    const Vec3d local = now.inverse().point(position);
    return glm::dvec3((then.matrix - now.matrix) * glm::dvec4(local, 1.0));
}

std::array<Vec3d, 3> corners(const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.data().triangles[triangle];
    const auto& p = mesh.data().positions;
    return {Vec3d(p[a]), Vec3d(p[b]), Vec3d(p[c])};
}

std::optional<Vec3d> movement(const TriangleMesh& now, std::uint32_t triangle, const Vec3d& position,
                              const TriangleMesh& then) {
    if (now.data().triangles.size() != then.data().triangles.size() ||
        triangle >= now.data().triangles.size())
        return std::nullopt;
    const auto from = corners(now, triangle), to = corners(then, triangle);
    const Vec3d e1 = from[1] - from[0], e2 = from[2] - from[0], d = position - from[0];
    const Vec3d normal = glm::cross(e1, e2);
    const double area = glm::dot(normal, normal);
    const double u = glm::dot(glm::cross(d, e2), normal) / area,
                 v = glm::dot(glm::cross(e1, d), normal) / area;
    return (1.0 - u - v) * (to[0] - from[0]) + u * (to[1] - from[1]) + v * (to[2] - from[2]);
}

std::optional<Vec3d> movement(const Curves& now, std::uint32_t segment, const Curves& then) {
    const CurveData &a = now.data(), &b = then.data();
    if (a.segments.size() != b.segments.size() || a.points.size() != b.points.size() ||
        segment >= a.segments.size())
        return std::nullopt;
    return Vec3d(b.points[b.segments[segment]]) - Vec3d(a.points[a.segments[segment]]);
}

template <typename Kind, typename Found>
std::optional<Vec3d> if_both(const Shape& now, const Shape& then, const Found& found) {
    const auto *a = dynamic_cast<const Kind*>(&now), *b = dynamic_cast<const Kind*>(&then);
    return a && b ? found(*a, *b) : std::nullopt;
}

std::optional<Vec3d> movement(const Shape& now, std::uint32_t primitive, const Vec3d& position,
                              const Shape& then) {
    using Result = std::optional<Vec3d>;
    if (const Result r = if_both<TriangleMesh>(
            now, then, [&](const auto& a, const auto& b) { return movement(a, primitive, position, b); }))
        return r;
    if (const Result r = if_both<Curves>(
            now, then, [&](const auto& a, const auto& b) { return movement(a, primitive, b); }))
        return r;
    if (typeid(now) != typeid(then)) return std::nullopt;
    if (const Result r = if_both<AnalyticShape>(now, then, [&](const auto& a, const auto& b) -> Result {
            return moved_with(a.unit_to_world(), b.unit_to_world(), position);
        }))
        return r;
    return if_both<InstancedShape>(now, then, [&](const auto& a, const auto& b) -> Result {
        const Vec3d local = a.placement().local_point(position);
        const auto within = movement(a.original(), primitive, local, b.original());
        if (!within) return std::nullopt;
        const Transform &from = a.placement().to_world(), &to = b.placement().to_world();
        return moved_with(from, to, position) + to.vector(*within);
    });
}

}  // namespace

std::optional<Vec3> moved_point(const Shape& now, std::uint32_t primitive, const Vec3d& position,
                                const Shape& then) {
    const auto by = movement(now, primitive, position, then);
    return by ? std::optional<Vec3>(Vec3(position + *by)) : std::nullopt;
}

}  // namespace mote::core
