#include "gathering/atlas/surface_place.h"

namespace mote::gathering {

using namespace core;

namespace {

template <typename T>
T interpolate(const std::array<T, 3>& corners, const Vec2& b) {
    return (1.0f - b.x - b.y) * corners[0] + b.x * corners[1] + b.y * corners[2];
}

/// Derivatives of the position by the texture coordinates; zero where those do not vary.
void find_derivatives(SurfaceHit& hit, const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& uv) {
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    const float determinant = a.x * b.y - a.y * b.x;
    if (determinant == 0.0f) return;
    hit.dp_du = (b.y * (p[1] - p[0]) - a.y * (p[2] - p[0])) / determinant;
    hit.dp_dv = (a.x * (p[2] - p[0]) - b.x * (p[1] - p[0])) / determinant;
}

}  // namespace

SurfaceHit surface_place(const SurfaceTriangles& surfaces, ShapeSpan shapes, std::uint32_t triangle,
                         const Vec2& barycentric) {
    const auto& corners = surfaces.corners[triangle];
    SurfaceHit hit;
    hit.position = interpolate(corners, barycentric);
    hit.geometric_normal =
        Vec3(glm::normalize(glm::cross(Vec3d(corners[1] - corners[0]), Vec3d(corners[2] - corners[0]))));
    hit.shape = shapes[surfaces.shape[triangle]].get();
    hit.primitive = surfaces.primitive[triangle];
    hit.uv = interpolate(surfaces.uvs[triangle], barycentric);
    hit.uv.attributes = hit.shape->attributes();
    hit.uv.primitive = hit.primitive, hit.uv.barycentric = barycentric;
    const Vec3 size =
        glm::abs(corners[0]) + glm::abs(corners[1] - corners[0]) + glm::abs(corners[2] - corners[0]);
    hit.error = 8.0f * std::numeric_limits<float>::epsilon() * max_component(size);
    Vec3 n = interpolate(surfaces.normals[triangle], barycentric);
    if (!(glm::dot(n, hit.geometric_normal) > 0.0f)) n = hit.geometric_normal;
    n = glm::normalize(n);
    if (hit.shape->tangent_matters) {
        find_derivatives(hit, corners, surfaces.uvs[triangle]);
        hit.shading = Frame(n, hit.dp_du);
    } else {
        hit.shading = Frame(n);
    }
    return hit;
}

}  // namespace mote::gathering
