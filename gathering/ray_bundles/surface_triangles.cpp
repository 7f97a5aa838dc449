#include "gathering/ray_bundles/surface_triangles.h"

#include <fmt/format.h>

#include "core/geometry/instances.h"
#include "core/geometry/triangle_mesh.h"
#include "core/materials/bsdf.h"
#include "core/objects/memory_error.h"
#include "gathering/ray_bundles/curve_tubes.h"
#include "gathering/ray_bundles/tessellation.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::size_t bytes_per_triangle =
    sizeof(std::array<Vec3, 3>) * 2 + sizeof(std::array<Vec2, 3>) + 2 * sizeof(std::uint32_t);

const Shape& original_of(const Shape& shape) {
    const auto* placed = dynamic_cast<const InstancedShape*>(&shape);
    return placed ? placed->original() : shape;
}

std::size_t triangles_of(const Shape& shape, const TessellationSettings& settings) {
    if (const auto* mesh = dynamic_cast<const TriangleMesh*>(&original_of(shape)))
        return mesh->data().triangles.size();
    if (const auto* curves = dynamic_cast<const Curves*>(&original_of(shape)))
        return tube_cuts(*curves, settings.chord_error).triangles();
    return tessellation_of(shape, settings.chord_error).triangles();
}

Vec3 unit_or(const Vec3& n, const Vec3& otherwise) {
    const float length = glm::length(n);
    if (!(length > 1e-4f)) return otherwise;
    return glm::dot(n, otherwise) < 0.0f ? n / -length : n / length;
}

/// A mesh where it is, or where an instance places it.
void append_mesh(const TriangleMesh& mesh, const Placement* place, TriangleList& list) {
    const MeshData& data = mesh.data();
    const bool mirrored = place && place->to_world().determinant() < 0.0;
    for (std::uint32_t i = 0; i < data.triangles.size(); ++i) {
        TriangleList::Corner corners[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = data.triangles[i][k];
            TriangleList::Corner& c = corners[k];
            c.position = data.positions[vertex];
            if (!data.normals.empty()) c.normal = data.normals[vertex];
            c.uv = data.uvs.empty() ? Vec2(k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f) : data.uvs[vertex];
            if (!place) continue;
            c.position = Vec3(place->to_world().point(Vec3d(c.position)));
            if (c.normal != Vec3(0.0f)) c.normal = Vec3(place->world_normal(Vec3d(c.normal)));
        }
        if (mirrored) std::swap(corners[1], corners[2]);
        list.add(corners[0], corners[1], corners[2], i);
    }
}

}  // namespace

void TriangleList::add(const Corner& a, const Corner& b, const Corner& c, std::uint32_t primitive) {
    const Vec3d cross =
        glm::cross(Vec3d(b.position) - Vec3d(a.position), Vec3d(c.position) - Vec3d(a.position));
    const double area = glm::length(cross);
    const Vec3 face = area > 0.0 ? Vec3(cross / area) : Vec3(0, 0, 1);
    list_.corners.push_back({a.position, b.position, c.position});
    list_.normals.push_back({unit_or(a.normal, face), unit_or(b.normal, face), unit_or(c.normal, face)});
    list_.uvs.push_back({a.uv, b.uv, c.uv});
    list_.shape.push_back(shape_), list_.primitive.push_back(primitive);
    for (const Vec3& p : list_.corners.back()) list_.bounds.extend(p);
}

SurfaceTriangles surface_triangles(std::span<const std::shared_ptr<Shape>> shapes,
                                   const TessellationSettings& settings) {
    std::vector<std::uint32_t> seen;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        if (shapes[i]->bsdf && shapes[i]->bsdf->traits().passes_straight()) continue;
        seen.push_back(i), count += triangles_of(*shapes[i], settings);
    }
    const double bytes = double(count) * double(bytes_per_triangle);
    if (!(bytes <= double(settings.memory_budget)))
        throw InputError(
            fmt::format("the scene's {} triangles take{}, more than the{} allowed for ray-bundles", count,
                        memory_text(bytes), memory_text(double(settings.memory_budget))));
    SurfaceTriangles result;
    with_memory_for("the scene's triangles for ray-bundles" + memory_text(bytes), [&] {
        result.corners.reserve(count), result.normals.reserve(count), result.uvs.reserve(count);
        result.shape.reserve(count), result.primitive.reserve(count);
    });
    for (const std::uint32_t i : seen) {
        const Shape& shape = *shapes[i];
        TriangleList list(result, i);
        const auto* placed = dynamic_cast<const InstancedShape*>(&shape);
        const Placement* place = placed ? &placed->placement() : nullptr;
        if (const auto* mesh = dynamic_cast<const TriangleMesh*>(&original_of(shape)))
            append_mesh(*mesh, place, list);
        else if (const auto* curves = dynamic_cast<const Curves*>(&original_of(shape)))
            append_tubes(*curves, place, tube_cuts(*curves, settings.chord_error), list);
        else
            append_tessellated(shape, tessellation_of(shape, settings.chord_error), list);
    }
    return result;
}

}  // namespace mote::gathering
