// Transforms, orientation and computed normals of meshes, in double precision.
#include "core/geometry/mesh_edits.h"

#include <tbb/parallel_for.h>

namespace mote::core {
namespace {

void swap_corners(MeshData& data) {
    for (auto& triangle : data.triangles) std::swap(triangle[1], triangle[2]);
}

/// Unit length, or zero where there is no direction: the geometric normal is used there.
Vec3 unit_or_zero(const Vec3d& n) {
    const double length = glm::length(n);
    return length > 0.0 && std::isfinite(length) ? Vec3(n / length) : Vec3(0.0f);
}

double angle_between(const Vec3d& a, const Vec3d& b) {
    // atan2 keeps its accuracy for the smallest angles, which acos loses.
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The triangle's normal times its angle at each corner; zero where it has no area.
std::array<Vec3d, 3> corner_normals(const MeshData& data, const std::array<std::uint32_t, 3>& triangle) {
    std::array<Vec3d, 3> p, result{};
    for (std::size_t i = 0; i < 3; ++i) p[i] = Vec3d(data.positions[triangle[i]]);
    const Vec3d cross = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(cross);
    if (!(length > 0.0)) return result;
    for (std::size_t i = 0; i < 3; ++i)
        result[i] = cross / length * angle_between(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
    return result;
}

}  // namespace

void transform_mesh(MeshData& data, const Transform& to_world) {
    for (Vec3& p : data.positions) p = Vec3(to_world.point(Vec3d(p)));
    const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(glm::dmat3(to_world.matrix)));
    for (Vec3& n : data.normals) n = unit_or_zero(normal_matrix * Vec3d(n));
    if (to_world.determinant() < 0.0) swap_corners(data);
}

void flip_orientation(MeshData& data) {
    swap_corners(data);
    for (Vec3& n : data.normals) n = -n;
}

void compute_vertex_normals(MeshData& data) {
    // Blocks of triangles at once, their sums one after the other: the same bits on any number of threads.
    constexpr std::size_t block = 1 << 16;
    std::vector<std::array<Vec3d, 3>> of_corners(std::min(block, data.triangles.size()));
    std::vector<Vec3d> sums(data.positions.size(), Vec3d(0.0));
    for (std::size_t begin = 0; begin < data.triangles.size(); begin += block) {
        const std::size_t count = std::min(block, data.triangles.size() - begin);
        tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
            of_corners[i] = corner_normals(data, data.triangles[begin + i]);
        });
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < 3; ++k) sums[data.triangles[begin + i][k]] += of_corners[i][k];
    }
    data.normals.resize(sums.size());
    tbb::parallel_for(std::size_t(0), sums.size(),
                      [&](std::size_t i) { data.normals[i] = unit_or_zero(sums[i]); });
}

MeshData back_side(const MeshData& mesh, float distance) {
    MeshData back = mesh;
    MeshData smooth = mesh;
    compute_vertex_normals(smooth);
    for (std::size_t i = 0; i < back.positions.size(); ++i) back.positions[i] -= distance * smooth.normals[i];
    flip_orientation(back);
    return back;
}

}  // namespace mote::core
