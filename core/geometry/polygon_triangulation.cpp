// Ear clipping in the plane of the polygon's Newell normal; O(n^2) for the polygons met in mesh files.
#include "core/geometry/polygon_triangulation.h"

#include <algorithm>

namespace mote::core {
namespace {

using Vec2d = glm::dvec2;

/// Twice the area of abc, positive counter-clockwise.
double twice_area(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon's corners without the coordinate in which its Newell normal is largest.
std::vector<Vec2d> project(std::span<const std::uint32_t> polygon, std::span<const Vec3> positions) {
    Vec3d normal(0.0);
    const Vec3d origin(positions[polygon[0]]);
    for (std::size_t i = 0; i < polygon.size(); ++i)
        normal += glm::cross(Vec3d(positions[polygon[i]]) - origin,
                             Vec3d(positions[polygon[(i + 1) % polygon.size()]]) - origin);
    const Vec3d size = glm::abs(normal);
    const int drop = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
    const int x = (drop + 1) % 3, y = (drop + 2) % 3;
    std::vector<Vec2d> points;
    for (const std::uint32_t vertex : polygon) {
        const Vec3d p = Vec3d(positions[vertex]) - origin;
        points.push_back(normal[drop] < 0.0 ? Vec2d(p[y], p[x]) : Vec2d(p[x], p[y]));
    }
    return points;
}

bool convex(const std::vector<Vec2d>& p) {
    for (std::size_t i = 0; i < p.size(); ++i)
        if (twice_area(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0.0) return false;
    return true;
}

/// True if the corner `left[i]` is an ear: convex, with no other corner inside its triangle.
bool is_ear(const std::vector<Vec2d>& p, const std::vector<std::uint32_t>& left, std::size_t i) {
    const std::size_t n = left.size();
    const std::uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
    if (!(twice_area(p[a], p[b], p[c]) > 0.0)) return false;
    return std::none_of(left.begin(), left.end(), [&](std::uint32_t q) {
        return q != a && q != b && q != c && p[q] != p[a] && p[q] != p[b] && p[q] != p[c] &&
               twice_area(p[a], p[b], p[q]) >= 0.0 && twice_area(p[b], p[c], p[q]) >= 0.0 &&
               twice_area(p[c], p[a], p[q]) >= 0.0;
    });
}

}  // namespace

void triangulate_polygon(std::span<const std::uint32_t> polygon, std::span<const Vec3> positions,
                         std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const auto n = std::uint32_t(polygon.size());
    if (n < 3) return;
    if (n == 3) {
        triangles.push_back({polygon[0], polygon[1], polygon[2]});
        return;
    }
    std::vector<std::uint32_t> left;  // corners not yet cut off
    if (n <= 256) {
        const std::vector<Vec2d> points = project(polygon, positions);
        if (!convex(points)) {
            for (std::uint32_t i = 0; i < n; ++i) left.push_back(i);
            for (std::size_t i = 0, misses = 0; left.size() > 3 && misses < left.size();) {
                i %= left.size();
                if (!is_ear(points, left, i)) {
                    ++i, ++misses;
                    continue;
                }
                const std::size_t size = left.size();
                triangles.push_back(
                    {polygon[left[(i + size - 1) % size]], polygon[left[i]], polygon[left[(i + 1) % size]]});
                left.erase(left.begin() + std::ptrdiff_t(i));
                misses = 0;
            }
        }
    }
    if (left.empty())
        for (std::uint32_t i = 0; i < n; ++i) left.push_back(i);
    // A convex polygon, or one that crosses itself so that no ear is left.
    for (std::size_t i = 2; i < left.size(); ++i)
        triangles.push_back({polygon[left[0]], polygon[left[i - 1]], polygon[left[i]]});
}

}  // namespace mote::core
