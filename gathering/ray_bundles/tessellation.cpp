#include "gathering/ray_bundles/tessellation.h"

#include <algorithm>

namespace mote::gathering {

using namespace core;

namespace {

constexpr int min_pieces = 8;  // of each side, so that no bend hides between the points that are tested
constexpr float shortest = 0x1p-16f;  // side of a piece

float distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const float length_squared = glm::dot(along, along);
    const float t =
        length_squared > 0.0f ? std::clamp(glm::dot(p - a, along) / length_squared, 0.0f, 1.0f) : 0.0f;
    return glm::length(p - (a + t * along));
}

/// Distance by which the surface bends between two points of the square [m].
float bend(const Shape& shape, const Vec2& from, const Vec2& to) {
    const Vec3 a = shape.sample_area(from).position, b = shape.sample_area(to).position;
    float most = 0.0f;
    for (const float t : {0.25f, 0.5f, 0.75f})
        most = std::max(most, distance_to_segment(shape.sample_area(glm::mix(from, to, t)).position, a, b));
    return most;
}

/// Cuts [from, to] until the surface bends by at most `tolerance` along `axis`, wherever it is on the other.
void cut(const Shape& shape, int axis, float from, float to, float tolerance, std::vector<float>& cuts) {
    float most = 0.0f;
    for (int i = 0; i <= min_pieces; ++i) {
        Vec2 a(float(i) / min_pieces), b = a;
        a[axis] = from, b[axis] = to;
        most = std::max(most, bend(shape, a, b));
    }
    const float middle = 0.5f * (from + to);
    if (most > tolerance && to - from > shortest) {
        cut(shape, axis, from, middle, tolerance, cuts), cut(shape, axis, middle, to, tolerance, cuts);
        return;
    }
    cuts.push_back(to);
}

std::vector<float> cuts_along(const Shape& shape, int axis, float tolerance) {
    std::vector<float> cuts = {0.0f};
    for (int i = 0; i < min_pieces; ++i)
        cut(shape, axis, float(i) / min_pieces, float(i + 1) / min_pieces, tolerance, cuts);
    return cuts;
}

/// Corners on the square's grid, row by row of xs.
std::vector<TriangleList::Corner> grid_of(const Shape& shape, const Tessellation& t) {
    std::vector<TriangleList::Corner> grid;
    grid.reserve(t.xs.size() * t.ys.size());
    const float same = 1e-5f * glm::length(shape.bounds().diagonal());
    for (const float x : t.xs) {
        const std::size_t row = grid.size();
        for (const float y : t.ys) {
            const ShapeSample sample = shape.sample_area({x, y});
            grid.push_back({sample.position, sample.normal, sample.uv});
            // The seam, where the last column meets the first, and poles, where a row is one point.
            if (y > 0.0f && glm::length(sample.position - grid[row].position) < same &&
                (y == 1.0f || x == 0.0f || x == 1.0f))
                grid.back().position = grid[row].position;
        }
    }
    return grid;
}

/// Texture coordinates around a body jump from 1 to 0 somewhere; within a triangle they continue.
void unwrap(TriangleList::Corner (&corners)[3]) {
    const float most = std::max({corners[0].uv.x, corners[1].uv.x, corners[2].uv.x});
    for (auto& c : corners)
        if (most - c.uv.x > 0.5f) c.uv.x += 1.0f;
}

void add_outside(TriangleList::Corner a, TriangleList::Corner b, TriangleList::Corner c, TriangleList& list) {
    const Vec3 cross = glm::cross(b.position - a.position, c.position - a.position);
    if (a.position == b.position || b.position == c.position || c.position == a.position) return;
    TriangleList::Corner corners[3] = {a, b, c};
    if (glm::dot(cross, a.normal + b.normal + c.normal) < 0.0f) std::swap(corners[1], corners[2]);
    unwrap(corners);
    list.add(corners[0], corners[1], corners[2], 0);
}

}  // namespace

Tessellation tessellation_of(const Shape& shape, float chord_error) {
    // Half of it along each axis.
    const float tolerance = 0.5f * std::max(chord_error, 1e-6f) * glm::length(shape.bounds().diagonal());
    return {cuts_along(shape, 0, tolerance), cuts_along(shape, 1, tolerance)};
}

void append_tessellated(const Shape& shape, const Tessellation& t, TriangleList& list) {
    const auto grid = grid_of(shape, t);
    const std::size_t columns = t.ys.size();
    for (std::size_t x = 0; x + 1 < t.xs.size(); ++x)
        for (std::size_t y = 0; y + 1 < columns; ++y) {
            const auto &a = grid[x * columns + y], &b = grid[x * columns + y + 1],
                       &c = grid[(x + 1) * columns + y], &d = grid[(x + 1) * columns + y + 1];
            add_outside(a, c, b, list), add_outside(b, c, d, list);
        }
}

}  // namespace mote::gathering
