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
// Two passes A and B, which have no path in common, make the variance of a pixel
//   (A - B)^2 / 2 + (that of A's queries + that of B's) / 2.                                         (3)
#pragma once

#include <optional>
#include <vector>

#include "integrators/upbp/merge_efforts.h"

namespace mote::integrators {

/// Light that the trial found in a pixel, at full efforts.
struct TrialSample {
    float light = 0.0f;            ///< mean over channels
    float weight = 1.0f;           ///< of multiple importance sampling
    PerMerge share{};              ///< of each technique in the density with which its path is found
    std::optional<Merge> merge{};  ///< none: a connection
    std::uint32_t query = 0;       ///< merges of one query are sought together
    bool needs_ray = false;        ///< tested by chance (chance_of_ray())
};

/// Samples of a pixel in two passes; those of a query follow one another.
using TrialPixel = std::array<std::vector<TrialSample>, 2>;

/// Samples of a trial, and its work.
struct Trial {
    std::vector<TrialPixel> pixels;   ///< of all pairs
    std::vector<TrialSample> splats;  ///< connections to the lens, of all passes
    int pairs = 1;                    ///< of passes
    double share_of_splats = 1.0;     ///< pixels of a pair, over those that splats were made for
    double work_of_paths = 0.0;       ///< of these pixels, with that of connections
    MergeWork work_of_merges;         ///< at full efforts, in the same units
};

/// Sum of the variances of the trial's pixels at these efforts, by Eq. (3).
double variance_at(const Trial& trial, const PerMerge& efforts);

/// Efforts of powers of 1/4 with the least variance times work; 1 where a technique is not used.
PerMerge efficient_efforts(const Trial& trial);

}  // namespace mote::integrators
