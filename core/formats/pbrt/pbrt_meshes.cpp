// Triangles, bilinear patches and surfaces of revolution.
#include "core/formats/pbrt/pbrt_meshes.h"

#include <algorithm>
#include <cmath>

namespace mote::core {
namespace {

using Indices = std::vector<std::uint32_t>;

/// "indices", checked; 0, 1, 2, ... where there are none and `implied` vertices.
Indices indices_of(const PbrtObject& shape, std::size_t vertices, std::size_t corners) {
    const PbrtParameter* p = shape.find("indices");
    Indices indices;
    if (!p && vertices == corners)
        for (std::uint32_t i = 0; i < corners; ++i) indices.push_back(i);
    if (!p && vertices != corners) throw InputError("the mesh has no indices", shape.where);
    if (p && p->numbers.size() % corners != 0)
        throw InputError(
            std::to_string(p->numbers.size()) + " indices are no multiple of " + std::to_string(corners),
            p->where);
    for (const double index : p ? p->numbers : std::vector<double>{}) {
        if (!(index >= 0.0 && index < double(vertices)) || index != std::floor(index))
            throw InputError("an index of the mesh names a vertex that is not there", p->where);
        indices.push_back(std::uint32_t(index));
    }
    return indices;
}

template <typename V>
std::vector<V> of_vertices(const PbrtObject& shape, const std::string& name, std::size_t vertices) {
    std::vector<V> values = shape.vectors<V>(name);
    if (!values.empty() && values.size() != vertices)
        throw InputError("'" + name + "' has " + std::to_string(values.size()) + " values for " +
                             std::to_string(vertices) + " vertices",
                         shape.find(name)->where);
    return values;
}

MeshData vertices_of(const PbrtObject& shape) {
    MeshData mesh;
    mesh.positions = shape.vectors<Vec3>("P");
    if (mesh.positions.empty()) throw InputError("the mesh has no vertices: 'P' is missing", shape.where);
    mesh.normals = of_vertices<Vec3>(shape, "N", mesh.positions.size());
    mesh.uvs = of_vertices<Vec2>(shape, shape.find("st") ? "st" : "uv", mesh.positions.size());
    return mesh;
}

/// Grid of (n + 1) x (m + 1) vertices as triangles; `first`: index of its first vertex.
void add_grid(MeshData& mesh, std::uint32_t first, std::uint32_t n, std::uint32_t m) {
    for (std::uint32_t j = 0; j < m; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = first + j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d}), mesh.triangles.push_back({a, d, c});
        }
}

/// A patch with corners at (u, v) = (0,0), (1,0), (0,1), (1,1).
void add_patch(MeshData& mesh, const MeshData& all, const std::uint32_t* corner) {
    const auto at = [&](const auto& list, float u, float v) {
        return glm::mix(glm::mix(list[corner[0]], list[corner[1]], u),
                        glm::mix(list[corner[2]], list[corner[3]], u), v);
    };
    const auto& p = all.positions;
    const Vec3 gap = p[corner[0]] + p[corner[3]] - p[corner[1]] - p[corner[2]];
    const std::uint32_t n = glm::length(gap) < 1e-5f * glm::length(p[corner[3]] - p[corner[0]]) ? 1 : 8;
    const std::uint32_t first = std::uint32_t(mesh.positions.size());
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const float u = float(i) / float(n), v = float(j) / float(n);
            mesh.positions.push_back(at(p, u, v));
            if (!all.normals.empty()) mesh.normals.push_back(at(all.normals, u, v));
            mesh.uvs.push_back(all.uvs.empty() ? Vec2(u, v) : at(all.uvs, u, v));
        }
    add_grid(mesh, first, n, n);
}

}  // namespace

void turn_to_normals(MeshData& mesh) {
    if (mesh.normals.empty()) return;
    for (auto& t : mesh.triangles) {
        const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
        const Vec3 side = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
        if (glm::dot(glm::cross(b - a, c - a), side) < 0.0f) std::swap(t[1], t[2]);
    }
}

double mesh_area(const MeshData& mesh) {
    double sum = 0.0;
    for (const auto& t : mesh.triangles) {
        const Vec3d a(mesh.positions[t[0]]);
        sum +=
            0.5 * glm::length(glm::cross(Vec3d(mesh.positions[t[1]]) - a, Vec3d(mesh.positions[t[2]]) - a));
    }
    return sum;
}

MeshData pbrt_triangle_mesh(const PbrtObject& shape) {
    shape.ignore({"S", "faceIndices"});
    MeshData mesh = vertices_of(shape);
    const Indices corners = indices_of(shape, mesh.positions.size(), 3);
    for (std::size_t i = 0; i < corners.size(); i += 3)
        mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    turn_to_normals(mesh);
    return mesh;
}

MeshData pbrt_bilinear_mesh(const PbrtObject& shape) {
    shape.ignore({"faceIndices", "emissionfilename"});
    const MeshData all = vertices_of(shape);
    const Indices corners = indices_of(shape, all.positions.size(), 4);
    MeshData mesh;
    for (std::size_t i = 0; i < corners.size(); i += 4) add_patch(mesh, all, &corners[i]);
    turn_to_normals(mesh);
    return mesh;
}

MeshData pbrt_quadric(const PbrtObject& shape) {
    constexpr std::uint32_t around = 128, along = 64;
    const double r = shape.number("radius", 1.0);
    const double turn = glm::radians(std::clamp(shape.number("phimax", 360.0), 1e-3, 360.0));
    const bool sphere = shape.type == "sphere", disk = shape.type == "disk";
    double z0 = 0.0, z1 = 0.0, inner = 0.0;
    if (disk)
        z0 = z1 = shape.number("height", 0.0), inner = shape.number("innerradius", 0.0);
    else
        z0 = shape.number("zmin", sphere ? -r : -1.0), z1 = shape.number("zmax", sphere ? r : 1.0);
    if (!(r > 0.0) || (!disk && !(z0 != z1))) throw InputError("the shape has no size", shape.where);
    if (z0 > z1) std::swap(z0, z1);
    const double t0 = std::asin(std::clamp(z0 / r, -1.0, 1.0)), t1 = std::asin(std::clamp(z1 / r, -1.0, 1.0));
    MeshData mesh;
    const std::uint32_t rows = sphere ? along : 1;
    for (std::uint32_t j = 0; j <= rows; ++j)
        for (std::uint32_t i = 0; i <= around; ++i) {
            const double u = double(i) / around, v = double(j) / rows, phi = u * turn, t = t0 + v * (t1 - t0);
            const Vec2 out(float(std::cos(phi)), float(std::sin(phi)));
            // A disk's v runs inwards, so that its normal is +z like that of the others is outwards.
            const double radius = sphere ? r * std::cos(t) : disk ? r + v * (inner - r) : r;
            mesh.positions.emplace_back(out * float(radius),
                                        float(sphere ? r * std::sin(t) : z0 + v * (z1 - z0)));
            mesh.normals.push_back(disk     ? Vec3(0, 0, 1)
                                   : sphere ? Vec3(out * float(std::cos(t)), float(std::sin(t)))
                                            : Vec3(out, 0));
            mesh.uvs.emplace_back(float(u), float(v));
        }
    add_grid(mesh, 0, around, rows);
    // Rows at a pole have triangles without area.
    std::erase_if(mesh.triangles, [&](const auto& c) {
        const auto& p = mesh.positions;
        return glm::length(glm::cross(p[c[1]] - p[c[0]], p[c[2]] - p[c[0]])) < 1e-12f * float(r * r);
    });
    return mesh;
}

}  // namespace mote::core
