#include "screenspace/ssbc/ssbc_camera.h"

#include <cmath>

namespace mote::screenspace {

using namespace core;

namespace {

/// Least squares for v = offset + slope u.
struct Line {
    double n = 0.0, u = 0.0, v = 0.0, uu = 0.0, uv = 0.0;
    void add(double a, double b) { n += 1.0, u += a, v += b, uu += a * a, uv += a * b; }
    double spread() const { return uu - u * u / n; }
    double slope() const { return (uv - u * v / n) / spread(); }
    double offset() const { return (v - slope() * u) / n; }
};

}  // namespace

std::optional<FittedCamera> fit_camera(int width, int height, std::span<const Vec3> position,
                                       std::span<const std::uint8_t> shown, const RowMatrix& m) {
    glm::dmat4 matrix;  // for column vectors
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) matrix[row][column] = m[std::size_t(4 * row + column)];
    const glm::dmat4 inverse = glm::inverse(matrix);
    if (!std::isfinite(inverse[3][0]) || !(std::abs(glm::determinant(matrix)) > 0.0)) return std::nullopt;

    const auto for_each = [&](const auto& f) {
        for (std::size_t i = 0; i < position.size(); ++i) {
            if (!shown[i]) continue;
            const Vec3d p(matrix * glm::dvec4(Vec3d(position[i]), 1.0));
            const double column = double(i % std::size_t(width)) + 0.5,
                         row = double(i / std::size_t(width)) + 0.5;
            if (p.z != 0.0) f(p.x / p.z, p.y / p.z, column, row, p.z);
        }
    };
    Line columns, rows;
    double depth = 0.0;
    for_each([&](double x, double y, double column, double row, double z) {
        columns.add(x, column), rows.add(y, row), depth += z;
    });
    const bool has_columns = width > 1 && columns.spread() > 1e-12,
               has_rows = height > 1 && rows.spread() > 1e-12;
    if (columns.n < 4 || (width > 1 && !has_columns) || (height > 1 && !has_rows)) return std::nullopt;
    if (!has_columns && !has_rows) return std::nullopt;

    double squares = 0.0;
    for_each([&](double x, double y, double column, double row, double) {
        if (has_columns) squares += std::pow(columns.offset() + columns.slope() * x - column, 2.0);
        if (has_rows) squares += std::pow(rows.offset() + rows.slope() * y - row, 2.0);
    });
    const double across = has_columns ? columns.slope() : rows.slope();
    const double down = has_rows ? rows.slope() : columns.slope();
    FittedCamera camera;
    camera.eye = Vec3d(inverse[3]);
    camera.forward = glm::normalize(Vec3d(inverse * glm::dvec4(0.0, 0.0, depth > 0.0 ? 1.0 : -1.0, 0.0)));
    camera.pixel_area = 1.0 / std::abs(across * down);
    camera.error = std::sqrt(squares / columns.n);
    return camera;
}

}  // namespace mote::screenspace
