// Least squares by Householder reflections, for the tall and narrow matrices of block-wise regression.
//
// A reflection turns what is left x of a column into (alpha, 0, 0, ...). Of the two signs of alpha = ±|x| the
// one opposite to x_0 is taken, so that v = x - alpha e_0 adds two numbers of one sign; with the other one v
// cancels, down to 0 / 0 where x points along e_0 already (Golub 2013, §5.1). Normal equations
// would square the condition number, which for positions and their squares leaves single precision nothing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mote::screenspace {

/// Features in the first columns, what they are to explain (colours) in the others. Column by column; rows
/// are filled up with zeros to a multiple of `lanes`, which changes no sum.
class TallMatrix {
  public:
    static constexpr int lanes = 16;

    /// All zero.
    TallMatrix(int rows, int features, int colours);
    /// Sets the number of rows; all values become zero.
    void reset(int rows);

    int rows() const { return rows_; }
    int features() const { return features_; }
    int columns() const { return columns_; }
    std::span<float> column(int c) { return {values_.data() + std::size_t(c) * stride_, std::size_t(rows_)}; }
    std::span<const float> column(int c) const {
        return {values_.data() + std::size_t(c) * stride_, std::size_t(rows_)};
    }
    /// Rows with those that fill it up.
    int padded_rows() const { return int(stride_); }
    float* padded_column(int c) { return values_.data() + std::size_t(c) * stride_; }

  private:
    int rows_ = 0, features_, columns_;
    std::size_t stride_ = 0;
    std::vector<float> values_;
};

/// Smallest remainder of a column behind the reflections of those before it, as a fraction of the column:
/// below it the column depends on them (rounding leaves some 1e-6) and gets the coefficient zero.
inline constexpr float dependent_fraction = 1e-4f;

/// Coefficients x that make |A x - b| smallest for every colour b, colour by colour: features() numbers each.
/// The matrix is used up. Finite for every finite matrix whose squares do not overflow, of any rank. Throws
/// std::invalid_argument for another number of coefficients.
void solve_least_squares(TallMatrix& matrix, std::span<float> coefficients);

}  // namespace mote::screenspace
