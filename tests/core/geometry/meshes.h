// Meshes and random triangles that several tests of geometry share.
#pragma once

#include <cmath>

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/ray_tracer.h"
#include "core/geometry/triangle_mesh.h"
#include "core/math/random.h"
#include "core/math/warp.h"

namespace mote::tests {

using namespace mote::core;

/// A closed sphere of 2 * slices * (stacks - 1) triangles with shared vertices.
inline MeshData sphere_mesh(const Vec3& center, float radius, std::uint32_t slices, std::uint32_t stacks) {
    MeshData data;
    const auto add = [&](double theta, double phi) {
        data.positions.push_back(center + radius * Vec3(float(std::sin(theta) * std::cos(phi)),
                                                        float(std::sin(theta) * std::sin(phi)),
                                                        float(std::cos(theta))));
    };
    add(0.0, 0.0);
    for (std::uint32_t j = 1; j < stacks; ++j)
        for (std::uint32_t i = 0; i < slices; ++i)
            add(double(pi) * j / stacks, 2.0 * double(pi) * i / slices);
    add(double(pi), 0.0);
    const auto at = [&](std::uint32_t j, std::uint32_t i) { return 1 + (j - 1) * slices + i % slices; };
    const auto south = std::uint32_t(data.positions.size() - 1);
    for (std::uint32_t i = 0; i < slices; ++i) {
        data.triangles.push_back({0, at(1, i), at(1, i + 1)});
        for (std::uint32_t j = 1; j + 1 < stacks; ++j) {
            data.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
            data.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
        }
        data.triangles.push_back({at(stacks - 1, i), south, at(stacks - 1, i + 1)});
    }
    return data;
}

inline MeshData one_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    MeshData data;
    data.positions = {a, b, c};
    data.triangles = {{0, 1, 2}};
    return data;
}

inline std::shared_ptr<TriangleMesh> mesh(MeshData data) {
    return std::make_shared<TriangleMesh>(std::move(data));
}

inline Ray ray(const Vec3& origin, const Vec3& direction, float t_max = infinity) {
    return {origin, glm::normalize(direction), 0.0f, t_max};
}

inline Transform translation(double x, double y, double z) {
    return Transform(glm::translate(glm::dmat4(1.0), Vec3d(x, y, z)));
}
inline Transform scaling(double x, double y, double z) {
    return Transform(glm::scale(glm::dmat4(1.0), Vec3d(x, y, z)));
}
inline Transform rotation(double degrees, const Vec3d& axis) {
    return Transform(glm::rotate(glm::dmat4(1.0), degrees * double(pi) / 180.0, glm::normalize(axis)));
}

}  // namespace mote::tests
