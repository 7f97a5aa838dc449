// Triangle meshes: checks at construction, hits from barycentric coordinates, sampling by area.
#include "core/geometry/triangle_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/geometry/mesh_checks.h"
#include "core/geometry/rounding.h"
#include "core/math/warp.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

/// Embree takes the side of a ray's origin O from dot(v - O, N), with N the cross product of two edges, both
/// relative to O and in single precision. With E the extents of the triangle's box, every product in it is
/// bounded by E_x E_y E_z; counting all roundings in the worst order gives 84 of half an ulp each. The
/// largest met in 3e8 rays leaving random triangles of all shapes and scales is 4.6.
constexpr double plane_error_factor = 12.0;

/// Twice the area long, along the normal.
Vec3d cross_of(const std::array<Vec3, 3>& corners) {
    const Vec3d p0(corners[0]);
    return glm::cross(Vec3d(corners[1]) - p0, Vec3d(corners[2]) - p0);
}
double area_of(const std::array<Vec3, 3>& corners) { return 0.5 * glm::length(cross_of(corners)); }

}  // namespace

TriangleMesh::Triangle::Triangle(const std::array<Vec3, 3>& c) : corners(c) {
    const Vec3d cross = cross_of(corners), zero(0.0), p0(c[0]), e1 = Vec3d(c[1]) - p0, e2 = Vec3d(c[2]) - p0;
    const double inverse = 1.0 / glm::length(cross);
    const Vec3d extent = glm::max(glm::max(e1, e2), zero) - glm::min(glm::min(e1, e2), zero);
    normal = Vec3(cross * inverse);
    plane_error = float(plane_error_factor * half_ulp * (extent.x * extent.y * extent.z) * inverse);
}

TriangleMesh::TriangleMesh(MeshData given) {
    const auto built = std::make_shared<Built>();
    MeshData& data = built->data = std::move(given);
    check_mesh(data, {});
    if (const std::size_t degenerate = count_degenerate_triangles(data); degenerate > 0) {
        built->closed.get([&] { return is_closed(data); });  // now: a needle may hold a seam together
        drop_degenerate_triangles(data);
        notes.push_back(std::to_string(degenerate) + " degenerate triangle" + (degenerate == 1 ? "" : "s") +
                        " dropped");
    }
    if (data.triangles.empty()) throw InputError("the mesh has no triangle with an area");

    // Embree reads 16 bytes for every vertex, so four bytes behind the last one must be ours.
    data.positions.reserve(data.positions.size() + 1);

    built->triangles.resize(data.triangles.size());
    tbb::parallel_for(std::size_t(0), data.triangles.size(), [&](std::size_t i) {
        const auto& [a, b, c] = data.triangles[i];
        built->triangles[i] = Triangle({data.positions[a], data.positions[b], data.positions[c]});
    });
    double sum = 0.0;  // one after the other: the same bits on any number of threads
    for (const Triangle& triangle : built->triangles) {
        sum += area_of(triangle.corners);
        for (const Vec3& corner : triangle.corners) built->bounds.extend(corner);
    }
    built->area = float(sum);
    if (!(built->area > std::numeric_limits<float>::min()) || !std::isfinite(built->area))
        throw InputError("the area of the mesh is out of range");
    built->halves = find_halves(built->triangles);
    built_ = built;
}

bool TriangleMesh::closed() const {
    return built_->closed.get([&] { return is_closed(built_->data); });
}

/// Relative to the largest, so that tiny triangles do not underflow.
const Distribution1D& TriangleMesh::areas() const {
    return built_->areas.get([&triangles = built_->triangles] {
        double largest = 0.0;
        for (const Triangle& triangle : triangles) largest = std::max(largest, area_of(triangle.corners));
        std::vector<float> areas;
        areas.reserve(triangles.size());
        for (const Triangle& triangle : triangles)
            areas.push_back(float(area_of(triangle.corners) / largest));
        return Distribution1D(areas);
    });
}

void TriangleMesh::fill_hit(std::uint32_t primitive, float u, float v, SurfaceHit& hit) const {
    const Triangle& triangle = built_->triangles[primitive];
    hit.position = triangle.point(u, v);
    hit.geometric_normal = triangle.normal;
    hit.error = triangle.error(hit.position);
    const Vec3 n = shading_normal(primitive, u, v, hit.geometric_normal);
    if (tangent_matters) fill_derivatives(primitive, hit);
    hit.shading = tangent_matters ? Frame(n, hit.dp_du) : Frame(n);
    hit.uv = texture_coordinates(primitive, u, v);
    hit.shape = this;
    hit.primitive = primitive;
}

DirectionCone TriangleMesh::normals() const {
    Vec3d sum(0.0);  // twice the area's vector; zero for closed meshes
    for (const Triangle& triangle : built_->triangles) sum += cross_of(triangle.corners);
    const double length = glm::length(sum);
    if (!(length > 1e-3 * double(built_->area))) return DirectionCone::all();
    const Vec3 axis(sum / length);
    float least = 1.0f;
    for (const Triangle& triangle : built_->triangles)
        least = std::min(least, glm::dot(axis, triangle.normal));
    return {axis, AngleOf::cosine(least).in_radians()};
}

float TriangleMesh::support(const Vec3& direction) const {
    const Vec3 center = built_->bounds.center();
    float farthest = -infinity;
    for (const auto& corners : built_->data.triangles)
        for (const std::uint32_t corner : corners)
            farthest = std::max(farthest, glm::dot(direction, built_->data.positions[corner] - center));
    return farthest;
}

Vec3 TriangleMesh::interpolated_normal(std::uint32_t primitive, float u, float v,
                                       const Vec3& geometric) const {
    const auto& corner = built_->data.triangles[primitive];
    const Vec3 n = (1.0f - u - v) * built_->data.normals[corner[0]] + u * built_->data.normals[corner[1]] +
                   v * built_->data.normals[corner[2]];
    const float length_squared = glm::dot(n, n);
    // Opposite normals cancel somewhere in between; there the direction is noise.
    if (!(length_squared > 1e-8f)) return geometric;
    const Vec3 unit = n / std::sqrt(length_squared);
    return glm::dot(unit, geometric) < 0.0f ? -unit : unit;
}

void TriangleMesh::fill_derivatives(std::uint32_t primitive, SurfaceHit& hit) const {
    const auto& corners = built_->triangles[primitive].corners;
    const Vec3d p0(corners[0]), e1 = Vec3d(corners[1]) - p0, e2 = Vec3d(corners[2]) - p0;
    hit.dp_du = Vec3(e1), hit.dp_dv = Vec3(e2);  // by barycentric coordinates
    if (built_->data.uvs.empty()) return;
    const Frame any(hit.geometric_normal);
    hit.dp_du = any.s, hit.dp_dv = any.t;
    const auto& [a, b, c] = built_->data.triangles[primitive];
    const glm::dvec2 uv0(built_->data.uvs[a]), uv1 = glm::dvec2(built_->data.uvs[b]) - uv0,
                                               uv2 = glm::dvec2(built_->data.uvs[c]) - uv0;
    // Derivatives of p = p0 + b1 e1 + b2 e2 and uv = uv0 + b1 uv1 + b2 uv2.
    const double determinant = uv1.x * uv2.y - uv1.y * uv2.x;
    const Vec3 dp_du((uv2.y * e1 - uv1.y * e2) / determinant);
    const Vec3 dp_dv((uv1.x * e2 - uv2.x * e1) / determinant);
    if (is_finite(dp_du) && is_finite(dp_dv)) hit.dp_du = dp_du, hit.dp_dv = dp_dv;
}

TextureCoordinates TriangleMesh::texture_coordinates(std::uint32_t primitive, float u, float v) const {
    TextureCoordinates result(u, v);
    if (!built_->data.uvs.empty()) {
        const auto& corner = built_->data.triangles[primitive];
        result = (1.0f - u - v) * built_->data.uvs[corner[0]] + u * built_->data.uvs[corner[1]] +
                 v * built_->data.uvs[corner[2]];
    }
    if (!built_->data.attributes.empty())
        result.attributes = this, result.primitive = primitive, result.barycentric = {u, v};
    return result;
}

std::optional<TriangleMesh::Halves> TriangleMesh::find_halves(std::span<const Triangle> triangles) {
    if (triangles.size() != 2) return std::nullopt;
    const auto corner = [&](std::size_t triangle, int i) {
        return triangles[triangle].corners[std::size_t(i) % 3];
    };
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const Vec3 a = corner(0, i + 1), b = corner(0, i + 2), c = corner(1, j + 1), d = corner(1, j + 2);
            if (!(a == c && b == d) && !(a == d && b == c)) continue;
            // Off by no more than the corners themselves are rounded.
            const Vec3d gap = Vec3d(corner(0, i)) + Vec3d(corner(1, j)) - Vec3d(a) - Vec3d(b);
            const Vec3d size = glm::abs(Vec3d(a)) + glm::abs(Vec3d(b));
            if (glm::all(glm::lessThanEqual(glm::abs(gap), 2.0 * half_ulp * size)))
                return Halves{i, j, a == c};
        }
    return std::nullopt;
}

/// A point of the unit square beyond its diagonal lies in the second triangle.
TriangleMesh::Point TriangleMesh::sample_point(const Vec2& u) const {
    if (!built_->halves) {
        const auto chosen = areas().sample_discrete(u.x);
        return {std::uint32_t(chosen.index), square_to_triangle({chosen.remapped, u.y})};
    }
    const auto& [first, second, turned] = *built_->halves;
    const bool beyond = u.x + u.y > 1.0f;
    std::array<float, 3> weights;  // of the corners
    const auto corner = std::size_t(beyond ? second : first);
    const float a = beyond ? 1.0f - u.y : u.x, b = beyond ? 1.0f - u.x : u.y;
    const bool swapped = beyond && !turned;
    weights[corner] = 1.0f - a - b;
    weights[(corner + 1) % 3] = swapped ? b : a, weights[(corner + 2) % 3] = swapped ? a : b;
    return {std::uint32_t(beyond), {weights[1], weights[2]}};
}

std::optional<Parallelogram> TriangleMesh::parallelogram() const {
    if (!built_->halves) return std::nullopt;
    const Triangle& triangle = built_->triangles[0];
    const auto corner = [&](int i) { return triangle.corners[std::size_t(built_->halves->first + i) % 3]; };
    return Parallelogram{corner(0), corner(1) - corner(0), corner(2) - corner(0), triangle.normal,
                         built_->area};
}

ShapeSample TriangleMesh::sample_area(const Vec2& u) const {
    const auto [primitive, b] = sample_point(u);
    const Triangle& triangle = built_->triangles[primitive];
    const Vec3 position = triangle.point(b.x, b.y);
    return {position, triangle.normal, texture_coordinates(primitive, b.x, b.y), 1.0f / built_->area,
            triangle.error(position)};
}

}  // namespace mote::core
