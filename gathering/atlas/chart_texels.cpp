#include "gathering/atlas/chart_texels.h"

#include <numeric>

#include "gathering/atlas/cell_pieces.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Contents of a cell, in sums over its pieces of triangles.
struct Cell {
    double area = 0.0;                  ///< of the surface [m^2]
    double cells = 0.0;                 ///< of the chart, in cells
    double largest = 0.0;               ///< piece, in cells
    Vec3d normal{0.0}, geometric{0.0};  ///< area-weighted
    std::uint32_t triangle = 0;         ///< with the largest piece, counted within the chart
    Vec2 barycentric{0.0f};             ///< of that piece's middle

    /// All of one cell, in a plane.
    bool whole() const {
        return std::fabs(cells - 1.0) < 1e-3 && glm::length(geometric) > (1.0 - 1e-6) * area;
    }

    void add(const Cell& other) {
        area += other.area, cells += other.cells;
        normal += other.normal, geometric += other.geometric;
        if (other.largest > largest)
            largest = other.largest, triangle = other.triangle, barycentric = other.barycentric;
    }
};

/// Barycentric coordinates of p, of its second and third corner.
Vec2 barycentric_of(const Vec2& p, const std::array<Vec2, 3>& c) {
    const glm::dvec2 a = c[1] - c[0], b = c[2] - c[0], d = p - c[0];
    const double determinant = a.x * b.y - a.y * b.x;
    return {float((d.x * b.y - d.y * b.x) / determinant), float((a.x * d.y - a.y * d.x) / determinant)};
}

std::vector<Cell> fill_cells(const SurfaceTriangles& surfaces, std::span<const std::uint32_t> triangles,
                             std::span<const std::array<Vec2, 3>> corners, std::uint32_t columns,
                             std::uint32_t rows) {
    std::vector<Cell> cells(std::size_t(columns) * rows);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::uint32_t t = triangles[i];
        const auto& p = surfaces.corners[t];
        const Vec3d cross = glm::cross(Vec3d(p[1] - p[0]), Vec3d(p[2] - p[0]));
        const Vec2 a = corners[i][1] - corners[i][0], b = corners[i][2] - corners[i][0];
        const double in_cells = 0.5 * std::fabs(double(a.x) * b.y - double(a.y) * b.x);
        if (!(in_cells > 0.0)) continue;
        const double metres = 0.5 * glm::length(cross) / in_cells;  // a cell's area on this triangle
        const Vec3d normal = glm::normalize(cross);
        for_each_piece(
            corners[i], columns, rows, [&](std::uint32_t x, std::uint32_t y, double area, const Vec2& at) {
                Cell piece;
                piece.cells = piece.largest = area, piece.area = area * metres;
                piece.triangle = std::uint32_t(i), piece.barycentric = barycentric_of(at, corners[i]);
                const Vec2 w = piece.barycentric;
                const auto& n = surfaces.normals[t];
                piece.geometric = normal * piece.area;
                piece.normal = Vec3d((1.0f - w.x - w.y) * n[0] + w.x * n[1] + w.y * n[2]) * piece.area;
                cells[std::size_t(y) * columns + x].add(piece);
            });
    }
    return cells;
}

/// Cells that became one texel, as a forest of cells.
class Regions {
  public:
    explicit Regions(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t child, std::uint32_t to) { parent_[child] = to; }

  private:
    std::vector<std::uint32_t> parent_;
};

template <typename Visit>
void for_each_neighbour(std::uint32_t cell, std::uint32_t columns, std::uint32_t rows, const Visit& visit) {
    const std::uint32_t x = cell % columns, y = cell / columns;
    if (x > 0) visit(cell - 1);
    if (x + 1 < columns) visit(cell + 1);
    if (y > 0) visit(cell - columns);
    if (y + 1 < rows) visit(cell + columns);
}

/// Joins each cell of less than half a cell of surface to the smallest of its neighbours, again and again.
void join_small(std::vector<Cell>& cells, Regions& regions, std::uint32_t columns, std::uint32_t rows) {
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
        if (!(cells[c].cells > 0.0) || regions.root(c) != c || cells[c].cells >= 0.5) continue;
        std::uint32_t best = SurfaceAtlas::none;
        for_each_neighbour(c, columns, rows, [&](std::uint32_t n) {
            if (!(cells[n].cells > 0.0)) return;
            const std::uint32_t r = regions.root(n);
            if (r != c && (best == SurfaceAtlas::none || cells[r].cells < cells[best].cells)) best = r;
        });
        if (best == SurfaceAtlas::none) continue;
        regions.join(c, best);
        cells[best].add(cells[c]);
    }
}

}  // namespace

ChartTexels make_chart_texels(const SurfaceTriangles& surfaces, std::span<const std::uint32_t> triangles,
                              std::span<const std::array<Vec2, 3>> corners, std::uint32_t columns,
                              std::uint32_t rows) {
    std::vector<Cell> cells = fill_cells(surfaces, triangles, corners, columns, rows);
    Regions regions(cells.size());
    join_small(cells, regions, columns, rows);
    ChartTexels result;
    result.texel_of_cell.assign(cells.size(), SurfaceAtlas::none);
    std::vector<std::uint32_t> queue;  // cells that have their texel, nearest to the surface first
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
        if (!(cells[c].cells > 0.0)) continue;
        queue.push_back(c);
        const std::uint32_t r = regions.root(c);
        if (result.texel_of_cell[r] == SurfaceAtlas::none) {
            const Cell& cell = cells[r];
            result.texel_of_cell[r] = std::uint32_t(result.texels.size());
            const std::uint32_t triangle = triangles[cell.triangle];
            const auto& p = surfaces.corners[triangle];
            const Vec2 middle = Vec2(float(r % columns), float(r / columns)) + 0.5f;
            const bool whole = cell.whole();
            const Vec2 w = whole ? barycentric_of(middle, corners[cell.triangle]) : cell.barycentric;
            const Vec3 geometric = glm::normalize(cell.geometric);
            const Vec3 position = (1.0f - w.x - w.y) * p[0] + w.x * p[1] + w.y * p[2];
            const Vec3 mean(glm::normalize(cell.normal));
            // Normals that cancel out say nothing; those that differ by rounding alone are the geometric one.
            const bool bent =
                glm::length(cell.normal) > 0.1 * cell.area && glm::dot(mean, geometric) < 0.99999f;
            result.texels.push_back({position, float(cell.area), bent ? mean : geometric, triangle, geometric,
                                     SurfaceSide::front, whole, w});
        }
        result.texel_of_cell[c] = result.texel_of_cell[r];
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        for_each_neighbour(queue[i], columns, rows, [&](std::uint32_t n) {
            if (result.texel_of_cell[n] != SurfaceAtlas::none) return;
            result.texel_of_cell[n] = result.texel_of_cell[queue[i]];
            queue.push_back(n);
        });
    return result;
}

}  // namespace mote::gathering
