// The error of a picture, with the bias of a filter, from two independent halves of its passes.
//
// a and b are the means of the halves, mu is their expectation, and f_a, f_b is what a filter makes of each
// by itself. With the errors e_a = f_a - mu, e_b and the noise d_a = a - mu, d_b, the picture (f_a + f_b) / 2
// has the squared error
//
//   |(e_a + e_b) / 2|^2 = |f_a - f_b|^2 / 4 + <e_a, e_b>,                                                (1)
//
// the noise that the filter has left, which is known, and a term whose mean is the square of its bias. The
// residuals r_a = a - f_a = d_a - e_a, r_b show that one:
//
//   <r_a, r_b> = <e_a, e_b> + t,  t = <d_a, d_b> - <d_a, e_b> - <e_a, d_b>,                              (2)
//
// and the mean of t is zero, since the halves are independent, whatever the filter is. No variance is
// subtracted that would have to be known (dual buffers: Rousselle et al. 2012). Where the noise is
// independent from pixel to pixel, and a filter is linear and symmetric, the sum of w t has the variance
//
//   s^2 = sum w^2 ((1 - 2 k)^2 v_a v_b + (o + beta^2) (v_a + v_b)),                                      (3)
//   k = <a - b, f_a - f_b> / |a - b|^2,  o = |f_a - f_b|^2 - k^2 |a - b|^2,  beta^2 = <r_a, r_b>,
//
// v_a and v_b being the variances of the halves, each measured in it alone: a square of one would count rare
// bright passes many times; k is the weight of a pixel's own noise in what is shown of it, and o the noise of
// other pixels. k, o and beta^2 are averages over blocks, (1 - 2 k)^2
// one that is weighted by |a - b|^4: filters are not linear, and treat rare bright paths in a way of their
// own. The sum is nearly normal, so Eq. (1) and (2) +- 1.96 s have 95 % confidence; the upper end is not
// below the noise that is known, and there is none where s is not known. Where a few bright paths make up the
// error, s has a long tail: it is mostly below what it is on average, and the interval contains the error
// less often.
//
// The rest <e_a, e_b> has the square of a bias for its mean, which is not below 0. That of one picture may
// be, by the noise that is left: n_a and n_b without bias make |(n_a + n_b) / 2|^2 of it, which varies as the
// known |n_a - n_b|^2 / 4 does. Where noise moves 16 pixels together, as filters leave it, it has 16 degrees
// of freedom in a block; the difference of both then has half the noise for its standard deviation. What a
// pixel keeps of its own noise varies by k^2 sqrt(v_a v_b). So, by two deviations of one and four of the
// other,
//
//   sum w <e_a, e_b> > -sqrt(sum N^2 + sum w^2 16 k^4 v_a v_b),  N = sum w |f_a - f_b|^2 / 4 of a block, (4)
//
// and the interval is that of a bounded mean (bounded_interval.h). Without a filter k is 1, the bound four s
// below 0, and the interval without it the same.
//
// Weights are relative to the light of a pixel, which is known with noise as well. With W_a and W_b, those of
// either half by itself, a block has the sums X_a and X_b; they differ by twice the standard error of their
// mean, and (X_a - X_b)^2 / 4 is added to s^2 (5).
//
// A rule that ends a render as soon as the upper end is low enough tests it after many numbers of passes, and
// ends where the rest is lowest by chance: with few passes, far below zero. The square of a bias is not, so
// the upper end for rules is
//
//   noise + max(0, rest) + 2.24 s,                                                                      (6)
//
// which is low only where s is small. Tests that follow each other share most of their passes: all that
// matter are taken for two, each of which may fail half as often (Bonferroni).
#pragma once

#include <array>
#include <initializer_list>
#include <limits>
#include <span>
#include <vector>

#include "core/metrics/bounded_interval.h"
#include "core/metrics/relative_error.h"

namespace mote::core {

/// Half of the passes: their mean, what is shown of it, and the variance of the mean.
struct PictureHalf {
    std::span<const Rgb> passes, shown, variance;
};

/// Relative RMSE, Eq. (2) of relative_error.h, with the ends of its interval of 95 % confidence.
struct PictureError {
    double error = std::numeric_limits<double>::infinity();  ///< infinity: not known
    double low = 0.0;                                        ///< end of the interval
    double high = std::numeric_limits<double>::infinity();   ///< end of the interval
    /// Upper end for a rule that is evaluated again and again, Eq. (6); nowhere below `high`.
    double rule_high = std::numeric_limits<double>::infinity();
    /// One error from those by several kinds of weights: its interval holds all of theirs.
    static PictureError of_all(std::initializer_list<PictureError> errors);
};

/// Squared error in the measure of Eq. (2) of relative_error.h, before it is divided by the norm.
struct SquaredError {
    double noise = 0.0;     ///< that is known
    double rest = 0.0;      ///< whose mean is the square of the bias
    double variance = 0.0;  ///< of `rest`
    double norm = 0.0;      ///< sum w |r|^2
    /// What the variance has more where the mean of `rest` is at the upper end.
    double more_above = 0.0;
    /// The true rest is not below this, Eq. (4).
    double lowest_rest = -std::numeric_limits<double>::infinity();
};

/// Interval of 95 % confidence; not known without a norm or a finite variance.
PictureError error_interval(const SquaredError& squared);

/// Error of blocks of pixels, row by row: the terms of the sums over the picture.
struct BlockErrors {
    static constexpr int size = 16;  ///< of a block [pixels]
    int columns = 0, rows = 0;       ///< numbers of blocks
    std::vector<double> noise;       ///< sum w |f_a - f_b|^2 / 4 of a block
    std::vector<double> rest;        ///< sum w <r_a, r_b> of a block, Eq. (2)
    std::vector<double> variance;    ///< of that sum, Eq. (3)
    std::vector<double> norm;        ///< sum w <a, b> of a block, whose mean is that of |r|^2
    std::vector<double> bound;       ///< square of how far the true rest may be below 0, Eq. (4)

    std::size_t index_of(std::size_t pixel, int width) const;  ///< of the block of a pixel
    SquaredError sum() const;                                  ///< of all blocks together
    PictureError of_picture() const { return error_interval(sum()); }
    PictureError of_block(std::size_t block) const;  ///< of one, relative to its own light
};

/// Throws std::invalid_argument when a size does not fit.
BlockErrors halves_error(const std::array<PictureHalf, 2>& halves, const RelativeWeights& weights, int width,
                         int height);

/// Adds Eq. (5) to the variance of each block of halves_error(): what noise in the weights does to its sums.
/// `weights`: of the passes of either half.
void add_variance_of_weights(BlockErrors& blocks, const std::array<PictureHalf, 2>& halves,
                             const std::array<RelativeWeights, 2>& weights, int width);

}  // namespace mote::core
