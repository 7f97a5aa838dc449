// Transforms, orientation and computed normals of meshes, in double precision.
#include "core/geometry/mesh_edits.h"

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
    std::vector<Vec3d> sums(data.positions.size(), Vec3d(0.0));
    for (const auto& triangle : data.triangles) {
        Vec3d p[3];
        for (std::size_t i = 0; i < 3; ++i) p[i] = Vec3d(data.positions[triangle[i]]);
        const Vec3d cross = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double length = glm::length(cross);
        if (!(length > 0.0)) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d &here = p[i], &next = p[(i + 1) % 3], &previous = p[(i + 2) % 3];
            sums[triangle[i]] += cross / length * angle_between(next - here, previous - here);
        }
    }
    data.normals.clear();
    for (const Vec3d& sum : sums) data.normals.push_back(unit_or_zero(sum));
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
