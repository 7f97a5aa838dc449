// The choice of efforts by what a trial has measured: the least variance times work (Grittmann et al. 2022,
// "Efficiency-aware multiple importance sampling for bidirectional rendering algorithms").
//
// By the balance heuristic light that any technique finds is f / sum_j n_j p_j. Efforts e_j change the sum to
// that of e_j n_j p_j, so with the shares s_j = n_j p_j / sum at full efforts
//   light at e = light / sum_j e_j s_j.                                                              (1)
// Samples of one trial at full efforts hence give the variance at any other. A query whose merges bring c_k
// is sought with the chance q = sqrt(e_t), in which each is found with the chance q again, independently of
// the rest of the pixel: the mean is q^2 S with S = sum c_k, and the variance
//   q (q^2 S^2 + q (1 - q) sum c_k^2) - q^4 S^2.                                                     (2)
// Connections of an eye vertex are tried together with the chance e, and each then has a ray with the chance
// h_k: the mean is e S, and the variance
//   e (S^2 + sum c_k^2 (1 / h_k - 1)) - e^2 S^2.                                                     (3)
// Two passes A and B, which have no path in common, make the variance of a pixel
//   (A - B)^2 / 2 + (that of A's queries and connections + that of B's) / 2.                         (4)
// What counts is the error over the pixel's own light, of which a block of pixels gives an idea.
#pragma once

#include <optional>
#include <vector>

#include "integrators/upbp/efforts.h"

namespace mote::integrators {

/// Light that the trial found in a pixel, at full efforts.
struct TrialSample {
    float light = 0.0f;    ///< mean over channels
    float weight = 1.0f;   ///< of multiple importance sampling
    PerTechnique share{};  ///< of each technique in the density with which its path is found
    std::optional<std::size_t> technique{};  ///< none: found at any effort
    std::uint32_t query = 0;                 ///< what one technique finds there is sought together
    bool needs_ray = false;                  ///< tested by chance (chance_of_ray())
};

/// Samples of a pixel in two passes; those of a query follow one another.
using TrialPixel = std::array<std::vector<TrialSample>, 2>;

/// A connection to the lens.
struct TrialSplat {
    TrialSample sample;
    std::size_t pixel = 0;  ///< that it falls on, or next to: index within a pair
};

/// Samples of a trial, and its work.
struct Trial {
    std::vector<TrialPixel> pixels;  ///< of one pair of passes after the other
    std::vector<TrialSplat> splats;  ///< of all passes
    int pairs = 1;                   ///< of passes
    double share_of_splats = 1.0;    ///< pixels of a pair, over those that splats were made for
    std::vector<double> weights;     ///< of variances, by pixel of a pair
    double work_of_paths = 0.0;      ///< of the pixels of a pair
    TechniqueWork work;              ///< at full efforts, in the same units
};

/// Sets the weights to 1 over the square of the light that a block of 64 pixels has, and a tenth of what half
/// of all pixels have. Medians of parts of eight pixels: no bright path makes its surroundings count less.
void set_weights_by_light(Trial& trial);

/// Weighted sum of the variances of the pixels at these efforts, by Eq. (4).
/// `outliers`: without this share of the pixels, those with most.
double variance_at(const Trial& trial, const PerTechnique& efforts, double outliers = 0.0);

/// Efforts of powers of 1/4 with the least variance times work; 1 where a technique is not used.
PerTechnique efficient_efforts(const Trial& trial);

}  // namespace mote::integrators
