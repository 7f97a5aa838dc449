// The Householder solver against Eigen's, in single and in double precision, on the matrices of blocks and on
// those that break one that chooses the other sign or divides without looking.
#include "screenspace/denoising/least_squares.h"

#include <Eigen/QR>
#include <cmath>
#include <functional>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::screenspace;

namespace {

TallMatrix filled(int rows, int features, int colours,
                  const std::function<float(int row, int column)>& value) {
    TallMatrix m(rows, features, colours);
    for (int c = 0; c < m.columns(); ++c)
        for (int r = 0; r < rows; ++r) m.column(c)[std::size_t(r)] = value(r, c);
    return m;
}

std::vector<float> solved(TallMatrix m) {
    std::vector<float> x(std::size_t(m.features()) * std::size_t(m.columns() - m.features()));
    solve_least_squares(m, x);
    return x;
}

template <typename Real>
std::vector<Real> by_eigen(const TallMatrix& m) {
    using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    Matrix all(m.rows(), m.columns());
    for (int c = 0; c < m.columns(); ++c)
        for (int r = 0; r < m.rows(); ++r) all(r, c) = Real(m.column(c)[std::size_t(r)]);
    const Matrix x =
        all.leftCols(m.features()).householderQr().solve(all.rightCols(m.columns() - m.features()));
    return {x.data(), x.data() + x.size()};
}

template <typename Real>
double largest_difference(const std::vector<float>& a, const std::vector<Real>& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::fmax(most, std::isfinite(a[i]) ? std::fabs(double(a[i]) - double(b[i])) : INFINITY);
    return most;
}

/// Features of a wall in [-1, 1] with noise against rank deficiency, and noisy colours.
TallMatrix block_of_wall(float noise) {
    Rng rng(7);
    TallMatrix m(1024, 10, 3);
    for (int r = 0; r < 1024; ++r) {
        const float x = float(r % 32) / 15.5f - 1.0f, y = float(r / 32) / 15.5f - 1.0f;
        const float z = 0.6f * x - 0.8f * y;  // a plane: the third coordinate follows from the others
        const float f[10] = {1, 0, 0, 0, x, x * x, y, y * y, z, z * z};
        for (int c = 0; c < 10; ++c)
            m.column(c)[std::size_t(r)] = f[c] + (c > 0 ? noise * (2.0f * rng.next_float() - 1.0f) : 0.0f);
        for (int c = 10; c < 13; ++c) m.column(c)[std::size_t(r)] = 2.0f + x + 3.0f * rng.next_float();
    }
    return m;
}

}  // namespace

TEST_CASE("Least squares are those of Eigen", "[denoising][least_squares]") {
    for (const int rows : {13, 16, 100, 1024}) {
        Rng rng{std::uint64_t(rows)};
        const TallMatrix m = filled(rows, 10, 3, [&](int, int) { return 2.0f * rng.next_float() - 1.0f; });
        const std::vector<float> x = solved(m);
        const auto exact = by_eigen<double>(m);
        const auto single = by_eigen<float>(m);
        const double ours = largest_difference(x, exact);
        double eigens = 0.0;
        for (std::size_t i = 0; i < exact.size(); ++i)
            eigens = std::fmax(eigens, std::fabs(double(single[i]) - exact[i]));
        CAPTURE(rows, ours, eigens);
        CHECK(ours < 1e-5 * (rows < 20 ? 100.0 : 1.0));  // few rows: a condition of some hundred
        CHECK(ours < 4.0 * eigens + 1e-7);
    }
    // A wall is singular but for its noise of 1e-2: a condition of about 1e3.
    const TallMatrix wall = block_of_wall(1e-2f);
    CHECK(largest_difference(solved(wall), by_eigen<double>(wall)) < 1e-2);
}

TEST_CASE("The sign of a reflection is the one that does not cancel", "[denoising][least_squares]") {
    // With the other one v is 0 for the first matrix, and the difference of two nearly equal numbers else.
    for (const float below : {0.0f, 1e-20f, 1e-4f, 1e-2f})
        for (const float sign : {1.0f, -1.0f}) {
            CAPTURE(below, sign);
            const TallMatrix m = filled(64, 2, 1, [&](int r, int c) {
                if (c == 0) return r == 0 ? sign : below * float(r % 3);
                if (c == 1) return r == 1 ? -sign : below * float(r % 5);
                return float(r < 2 ? 3 + r : 0);
            });
            const std::vector<float> x = solved(m);
            CHECK(largest_difference(x, by_eigen<double>(m)) < 2e-6 * 4.0);
        }
}

TEST_CASE("Columns that depend on others, or are zero, leave the solution finite",
          "[denoising][least_squares]") {
    const auto residual = [](const TallMatrix& m) {
        const std::vector<float> x = solved(m);
        double most = 0.0;
        for (int r = 0; r < m.rows(); ++r) {
            double fit = 0.0;
            for (int k = 0; k < m.features(); ++k)
                fit += double(m.column(k)[std::size_t(r)]) * double(x[std::size_t(k)]);
            most = std::fmax(most, std::fabs(fit - double(m.column(m.features())[std::size_t(r)])));
            if (!std::isfinite(fit)) return 1e30;
        }
        return most;
    };
    const auto wave = [](int r) { return std::sin(0.37f * float(r)); };
    // Zero columns, the same column twice, one that is the sum of others; b lies in the range all the same.
    CHECK(residual(filled(50, 4, 1, [&](int r, int c) { return c == 1 || c == 2 ? 0.0f : wave(r); })) < 1e-5);
    CHECK(residual(filled(50, 3, 1, [&](int r, int c) {
              return c == 0 ? 1.0f : c == 3 ? 2.0f - wave(r) : wave(r);
          })) < 1e-5);
    CHECK(residual(filled(50, 3, 1, [&](int r, int c) {
              return c == 0 ? 1.0f : c == 1 ? wave(r) : c == 2 ? 1.0f + 2.0f * wave(r) : 4.0f + wave(r);
          })) < 1e-5);
    CHECK(residual(filled(50, 3, 1, [](int, int) { return 0.0f; })) == 0.0);
    // Fewer rows than columns.
    CHECK(residual(filled(1, 10, 1, [](int, int c) { return c == 10 ? 5.0f : 1.0f / float(c + 1); })) < 1e-5);
    CHECK(residual(filled(4, 10, 1, [](int r, int c) { return std::cos(float(7 * r + 3 * c)); })) < 1e-4);
    const std::vector<float> nothing = solved(TallMatrix(0, 10, 3));
    CHECK(std::all_of(nothing.begin(), nothing.end(), [](float v) { return v == 0.0f; }));
}

TEST_CASE("A column that depends on others gets the coefficient zero", "[denoising][least_squares]") {
    // Rounding residuals of such a column point anywhere; noise in the colours would be fitted to them with
    // coefficients of millions.
    Rng rng(5);
    const TallMatrix m = filled(64, 4, 1, [&](int r, int c) {
        const float x = std::sin(0.37f * float(r)), y = std::cos(0.11f * float(r));
        return c == 0   ? 1.0f
               : c == 1 ? x
               : c == 2 ? y
               : c == 3 ? 0.3f + 0.7f * x - 0.4f * y
                        : rng.next_float();
    });
    const std::vector<float> x = solved(m);
    CHECK(x[3] == 0.0f);
    for (const float coefficient : x) CHECK(std::fabs(coefficient) < 1.0f);
}

TEST_CASE("Squares of positions that are not normalised are found", "[denoising][least_squares][planted]") {
    // A wall of a metre, ten kilometres from the origin: single precision has nothing left of its parabola.
    const auto error = [](double centre, double scale) {
        const TallMatrix m = filled(1024, 3, 1, [&](int r, int c) {
            const double x = double(r) / 1023.0, f = (1e4 + x - centre) * scale;
            return float(c == 0 ? 1.0 : c == 1 ? f : c == 2 ? f * f : x * x);
        });
        const std::vector<float> x = solved(m);
        double most = 0.0;
        for (int r = 0; r < 1024; ++r) {
            const auto at = [&](int c) { return m.column(c)[std::size_t(r)]; };
            most = std::fmax(most, std::fabs(double(at(0) * x[0] + at(1) * x[1] + at(2) * x[2] - at(3))));
        }
        return most;
    };
    CHECK(error(1e4 + 0.5, 2.0) < 1e-5);
    CHECK(error(0.0, 1.0) > 1e-2);
}
