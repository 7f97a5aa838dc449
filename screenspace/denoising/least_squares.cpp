#include "screenspace/denoising/least_squares.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "core/math/vectorize.h"

namespace mote::screenspace {

namespace {

constexpr int lanes = TallMatrix::lanes;

/// Sixteen sums side by side: vector instructions, and less rounding than one long sum.
float dot(const float* a, const float* b, int n) {
    std::array<float, lanes> sums{};
    for (int i = 0; i < n; i += lanes)
        for (int j = 0; j < lanes; ++j) sums[std::size_t(j)] += a[i + j] * b[i + j];
    for (int half = lanes / 2; half > 0; half /= 2)
        for (int j = 0; j < half; ++j) sums[std::size_t(j)] += sums[std::size_t(j + half)];
    return sums[0];
}

void add_scaled(float* y, float s, const float* v, int n) {
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < n; ++i) y[i] += s * v[i];
}

/// The reflection that turns rows `first` and below of a column into (alpha, 0, ...).
struct Reflection {
    float alpha = 0.0f;  ///< 0: the column depends on those before it, nothing is reflected
    float scale = 0.0f;  ///< 2 / |v|^2
};

/// Leaves v in the column, with zeros above `first`.
Reflection reflect_column(float* column, int first, int rows) {
    const float whole = dot(column, column, rows);
    float above = 0.0f;
    for (int i = 0; i < first; ++i) above += column[i] * column[i], column[i] = 0.0f;
    const float left = above > 0.0f ? dot(column, column, rows) : whole;
    if (!(left > dependent_fraction * dependent_fraction * whole)) return {};
    const float norm = std::sqrt(left), x0 = column[first];
    const float alpha = x0 > 0.0f ? -norm : norm;
    column[first] = x0 - alpha;
    // |v|^2 = |x|^2 - 2 alpha x_0 + alpha^2 = 2 (|x|^2 + |alpha x_0|)
    return {alpha, 1.0f / (left + std::fabs(alpha * x0))};
}

}  // namespace

TallMatrix::TallMatrix(int rows, int features, int colours)
    : features_(features), columns_(features + colours) {
    if (features < 1 || colours < 0) throw std::invalid_argument("a regression needs a feature");
    reset(rows);
}

void TallMatrix::reset(int rows) {
    rows_ = rows;
    stride_ = std::size_t((rows + lanes - 1) / lanes * lanes);
    values_.assign(stride_ * std::size_t(columns_), 0.0f);
}

void solve_least_squares(TallMatrix& matrix, std::span<float> coefficients) {
    const int features = matrix.features(), rows = matrix.padded_rows();
    if (coefficients.size() != std::size_t(features) * std::size_t(matrix.columns() - features))
        throw std::invalid_argument("coefficients do not fit the matrix");
    // R above the diagonal stays in the columns; v takes the place of what it has turned into zeros.
    std::vector<float> v(static_cast<std::size_t>(rows)), diagonal(static_cast<std::size_t>(features), 0.0f);
    std::vector<int> row_of(static_cast<std::size_t>(features), -1);  // -1: left out
    int rank = 0;
    for (int k = 0; k < features && rank < matrix.rows(); ++k) {
        const float* column = matrix.padded_column(k);
        v.assign(column, column + rows);
        const Reflection reflection = reflect_column(v.data(), rank, rows);
        if (reflection.alpha == 0.0f) continue;
        const int first = rank / lanes * lanes;  // v is zero above
        for (int c = k + 1; c < matrix.columns(); ++c) {
            float* y = matrix.padded_column(c) + first;
            add_scaled(y, -reflection.scale * dot(v.data() + first, y, rows - first), v.data() + first,
                       rows - first);
        }
        diagonal[std::size_t(k)] = reflection.alpha, row_of[std::size_t(k)] = rank++;
    }
    for (int c = features; c < matrix.columns(); ++c) {
        float* x = coefficients.data() + std::size_t(c - features) * std::size_t(features);
        for (int k = features - 1; k >= 0; --k) {
            const int row = row_of[std::size_t(k)];
            x[k] = 0.0f;
            if (row < 0) continue;
            float rest = matrix.column(c)[std::size_t(row)];
            for (int j = k + 1; j < features; ++j) rest -= matrix.column(j)[std::size_t(row)] * x[j];
            x[k] = rest / diagonal[std::size_t(k)];
        }
    }
}

}  // namespace mote::screenspace
