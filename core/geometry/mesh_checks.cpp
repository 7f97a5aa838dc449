// Validity of meshes: refuse what cannot be traced, drop what has no area, find out what is closed.
#include "core/geometry/mesh_checks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <unordered_map>

namespace mote::core {
namespace {

std::string coordinates(const Vec3& p) {
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
}

/// Number of the first vertex at the same position, for every vertex.
std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size()), first(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const Vec3& p = positions[i];
        return std::tuple(p.x, p.y, p.z, i);
    };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

bool degenerate(const MeshData& data, const std::array<std::uint32_t, 3>& triangle) {
    const Vec3d p0(data.positions[triangle[0]]);
    const Vec3d e1 = Vec3d(data.positions[triangle[1]]) - p0, e2 = Vec3d(data.positions[triangle[2]]) - p0;
    const Vec3d e3 = e2 - e1;
    const double longest = std::max({glm::dot(e1, e1), glm::dot(e2, e2), glm::dot(e3, e3)});
    // The cross product of exact edges is wrong by a few 2^-53 of the longest edge squared.
    return !(glm::length(glm::cross(e1, e2)) > 0x1p-50 * longest);
}

}  // namespace

void check_mesh(const MeshData& data, const SourceLocation& where) {
    if (data.triangles.empty()) throw InputError("the mesh has no triangles", where);
    if (data.positions.size() >= 0xffffffffu) throw InputError("the mesh has too many vertices", where);
    for (std::size_t i = 0; i < data.positions.size(); ++i) {
        const Vec3& p = data.positions[i];
        if (!is_finite(p))
            throw InputError("vertex " + std::to_string(i) + " is not finite: " + coordinates(p), where);
        if (max_component(glm::abs(p)) > largest_coordinate)
            throw InputError("vertex " + std::to_string(i) + " lies beyond 1e18", where);
    }
    for (std::size_t i = 0; i < data.triangles.size(); ++i)
        for (const std::uint32_t vertex : data.triangles[i])
            if (vertex >= data.positions.size())
                throw InputError("triangle " + std::to_string(i) + " refers to vertex " +
                                     std::to_string(vertex) + " of " + std::to_string(data.positions.size()),
                                 where);
    if (!data.normals.empty() && data.normals.size() != data.positions.size())
        throw InputError("the mesh has not as many normals as positions", where);
    if (!data.uvs.empty() && data.uvs.size() != data.positions.size())
        throw InputError("the mesh has not as many texture coordinates as positions", where);
    for (const MeshAttribute& a : data.attributes)
        if (a.values.size() != (a.of_faces ? data.triangles.size() : data.positions.size()))
            throw InputError("attribute '" + printable(a.name) + "' has not a value for each " +
                                 (a.of_faces ? "triangle" : "vertex"),
                             where);
}

bool has_area(const MeshData& data) {
    return std::any_of(data.triangles.begin(), data.triangles.end(),
                       [&](const auto& triangle) { return !degenerate(data, triangle); });
}

std::size_t count_degenerate_triangles(const MeshData& data) {
    using Range = tbb::blocked_range<std::size_t>;
    return tbb::parallel_reduce(
        Range(0, data.triangles.size()), std::size_t(0),
        [&](const Range& range, std::size_t count) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
                count += degenerate(data, data.triangles[i]);
            return count;
        },
        std::plus<>());
}

void drop_degenerate_triangles(MeshData& data) {
    const std::size_t all = data.triangles.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < all; ++i) {
        if (degenerate(data, data.triangles[i])) continue;
        data.triangles[kept] = data.triangles[i];
        for (MeshAttribute& a : data.attributes)
            if (a.of_faces) a.values[kept] = a.values[i];
        ++kept;
    }
    data.triangles.resize(kept);
    for (MeshAttribute& a : data.attributes)
        if (a.of_faces) a.values.resize(kept);
}

bool is_closed(const MeshData& data) {
    const std::vector<std::uint32_t> vertex = weld(data.positions);
    // +1 for an edge passed from its lower to its higher vertex, -1 for the other way: all must cancel.
    std::vector<std::pair<std::uint64_t, int>> edges;
    edges.reserve(3 * data.triangles.size());
    for (const auto& triangle : data.triangles)
        for (int i = 0; i < 3; ++i) {
            const std::uint64_t a = vertex[triangle[i]], b = vertex[triangle[(i + 1) % 3]];
            if (a != b) edges.emplace_back(std::min(a, b) << 32 | std::max(a, b), a < b ? 1 : -1);
        }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        int sum = 0;
        const std::uint64_t edge = edges[i].first;
        for (; i < edges.size() && edges[i].first == edge; ++i) sum += edges[i].second;
        if (sum != 0) return false;
    }
    return !edges.empty();
}

}  // namespace mote::core
