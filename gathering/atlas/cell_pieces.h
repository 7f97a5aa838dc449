// A triangle cut along the lines of a grid: the piece in each cell.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/math/vec.h"

namespace mote::gathering {

/// A convex polygon of at most seven corners: a triangle cut by four lines.
struct Polygon {
    std::array<core::Vec2, 8> corners;
    int count = 0;

    void add(const core::Vec2& p) {
        if (count < 8) corners[std::size_t(count++)] = p;
    }
    /// The part where sign (p[axis] - limit) >= 0.
    Polygon cut(int axis, float limit, float sign) const {
        Polygon out;
        for (int i = 0; i < count; ++i) {
            const core::Vec2 a = corners[std::size_t(i)], b = corners[std::size_t((i + 1) % count)];
            const float da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
            if (da >= 0.0f) out.add(a);
            if ((da >= 0.0f) != (db >= 0.0f)) out.add(a + (b - a) * (da / (da - db)));
        }
        return out;
    }
    /// Signed area, and the centroid where it is not zero.
    double area(core::Vec2& centroid) const {
        double twice = 0.0, x = 0.0, y = 0.0;
        for (int i = 1; i + 1 < count; ++i) {
            const glm::dvec2 a = corners[0], b = corners[std::size_t(i)], c = corners[std::size_t(i + 1)];
            const double cross = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            twice += cross, x += cross * (a.x + b.x + c.x), y += cross * (a.y + b.y + c.y);
        }
        centroid = twice != 0.0 ? core::Vec2(x / (3.0 * twice), y / (3.0 * twice)) : corners[0];
        return 0.5 * twice;
    }
};

/// Calls visit(x, y, area, centroid) for each of columns x rows unit cells that the triangle reaches into.
/// Rounding beyond the border counts to the cell at the border. The area is positive in either orientation.
template <typename Visit>
void for_each_piece(const std::array<core::Vec2, 3>& triangle, std::uint32_t columns, std::uint32_t rows,
                    const Visit& visit) {
    const auto cell = [](float x, std::uint32_t n) {
        return std::uint32_t(std::min(std::max(x, 0.0f), float(n - 1)));
    };
    const core::Vec2 low = glm::min(triangle[0], glm::min(triangle[1], triangle[2]));
    const core::Vec2 high = glm::max(triangle[0], glm::max(triangle[1], triangle[2]));
    Polygon whole;
    for (const core::Vec2& p : triangle) whole.add(p);
    const std::uint32_t y_end = cell(high.y, rows), x_last = cell(high.x, columns);
    for (std::uint32_t y = cell(low.y, rows); y <= y_end; ++y) {
        Polygon row = whole;
        if (y > 0) row = row.cut(1, float(y), 1.0f);
        if (y + 1 < rows) row = row.cut(1, float(y + 1), -1.0f);
        for (std::uint32_t x = cell(low.x, columns); x <= x_last && row.count > 2; ++x) {
            Polygon piece = row;
            if (x > 0) piece = piece.cut(0, float(x), 1.0f);
            if (x + 1 < columns) piece = piece.cut(0, float(x + 1), -1.0f);
            if (piece.count < 3) continue;
            core::Vec2 centroid;
            const double area = std::fabs(piece.area(centroid));
            if (area > 0.0) visit(x, y, area, centroid);
        }
    }
}

}  // namespace mote::gathering
