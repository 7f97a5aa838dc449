// The error of a picture whose pixels share noise, and whose method leaves out light that another one finds.
//
// Passes of many-light methods have virtual lights in common: their noise moves many pixels together, and
// how far off one picture is differs much from the mean over seeds. The mean T of the light differs from the
// mean mu of the passes by the light m = T - mu that a bound on the geometry term takes. The picture X is the
// mean of N passes in G groups, group g with n_g passes and the mean Y_g. With <x, y> = sum w x y / sum w
// |r|^2 over pixels and channels, the squared error is
//
//   |X - T|^2 = |X - mu|^2 - 2 <X - mu, m> + |m|^2.                                                      (1)
//
// Noise. With the covariance S of a pass, |X - mu|^2 has the mean tr S / N, which
//
//   A = sum_g n_g |Y_g - X|^2 / (N (G - 1))                                                              (2)
//
// estimates. It is a sum of nu = (tr S)^2 / tr S^2 squares of normal variables that count alike
// (Satterthwaite 1946), and A one of nu (G - 1), so |X - mu|^2 / A follows Fisher's F with so many degrees of
// freedom. Rare bright splotches are in A and in the picture alike: what differs are products of different
// passes, and tr S^2 is estimated from these alone, pairs of groups that have none in common:
//
//   tr S^2 = mean of <Y_a - Y_b, Y_c - Y_d>^2 / ((1/n_a + 1/n_b) (1/n_c + 1/n_d)).                       (3)
//
// Where the noise is a few splotches that seldom meet, most pictures show too little of (3): intervals are
// too narrow, and the error is mostly below them where it is not within.
//
// Light that is missing. Passes of their own estimate m, independent from pixel to pixel; with the means a, b
// of their halves, <a, b> has the mean |m|^2. The cross term of Eq. (1) has the mean 0 and the variance (4),
// and <a, b> the variance (5), with the variances u, v of a and b, each of these in the mean:
//
//   4 / N sum_g n_g <Y_g - X, a> <Y_g - X, b> / (G - 1),                                                 (4)
//   sum w^2 (|b|^2 u + |a|^2 v - u v).                                                                   (5)
//
// The interval has the quantiles of the sum of both, A F and a Student's t, as independent variables.
//
// Weights are relative to the light of a pixel, which is known with noise: by the mean of all passes a rare
// splotch, or a lamp that few passes meet, would be taken for a bright place, where an error counts for
// little; by the median over groups, or by its neighbours, one that is bright by rare paths for a dark one.
// Film::error() states what three kinds of weights make of it: relative_weights(), weights_of_groups(), and
// lower_weights(), by which the noise of no pixel exceeds its light.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/metrics/halves_error.h"

namespace mote::core {

/// Passes of one group: their number n_g, and their mean Y_g.
struct PassGroup {
    double passes = 0.0;
    std::vector<Rgb> mean;
};

/// Fewer groups say too little about their spread.
inline constexpr std::size_t min_pass_groups = 4;

/// Squared error by noise that pixels share, relative to the light: A F, with Fisher's F.
struct SharedNoise {
    double squared = 0.0;          ///< A, Eq. (2)
    double freedom = 0.0;          ///< nu, of the numerator
    double freedom_of_mean = 0.0;  ///< nu (G - 1), of the denominator
};

/// Eq. (2) and (3). `weights`: of the picture. Throws std::invalid_argument with fewer groups than
/// min_pass_groups, or where a size does not fit.
SharedNoise shared_noise(std::span<const PassGroup> groups, const RelativeWeights& weights);

/// Weights by medians over the groups, pixel by pixel, of light_squares() of Y_g + m; in the norm, of
/// |Y_g + m|^2. `missing`: m without most of its noise; may be empty. Throws as shared_noise().
RelativeWeights weights_of_groups(std::span<const PassGroup> groups, std::span<const Rgb> missing, int width,
                                  int height);

/// The error of the mean of all passes. `missing`: two halves of estimates of m, nothing shown of them
/// (PictureHalf::shown is not read); none where nothing is missing. Not known where the weights are those of
/// a black picture. Throws as shared_noise().
PictureError group_error(std::span<const PassGroup> groups, std::span<const PictureHalf> missing,
                         const RelativeWeights& weights);

}  // namespace mote::core
