// How often each technique is used: its effort, the probability of a query for merges, of sampling a light or
// of a connection, at an eye vertex or along an eye path's edge.
//
// An effort is a factor of the technique's density in all MIS weights, so any is unbiased, and techniques
// that find the same paths take over its share. Each costs time at every vertex; variance times work is to be
// least (Grittmann et al. 2022, "Efficiency-Aware Multiple Importance Sampling for Bidirectional Rendering
// Algorithms", choose numbers of light paths and connections by it).
//
// A query that finds merges of contributions c, with MIS weights w, has second moment (sum c)^2. As c falls
// with q by c w, and the second moment of what other techniques bring of the same paths by 2 c^2 (1 - w), the
// derivative of the variance by -log q is the mean of (derived)
//   B = 2 (sum c) (sum c w) - (sum c)^2 + 2 sum c^2 (1 - w),                                          (1)
// c^2 for a lone merge. Where one query finds many and w is below 1/2 it is negative: they share the noise of
// the eye path, which the balance heuristic does not know (Grittmann et al. 2021).
#pragma once

#include "integrators/upbp/technique_work.h"

namespace mote::integrators {

/// Sums over the merges that a query finds.
struct QuerySums {
    double light = 0.0;     ///< c
    double weighted = 0.0;  ///< c w
    double others = 0.0;    ///< c^2 (1 - w)

    /// `chance` with which it was tested: c holds 1 / chance.
    void add(double c, double w, double chance) {
        light += c, weighted += c * w, others += c * c * (1.0 - w) * chance;
    }
    /// Eq. (1).
    double benefit() const { return 2.0 * light * weighted - light * light + 2.0 * others; }
};

/// Found in trial passes with the same efforts, in one unit of work and one of squared light.
struct EffortTrial {
    double variance = 0.0;          ///< of a pixel
    double work = 0.0;              ///< of a pass
    PerTechnique benefit{};         ///< of a pixel, Eq. (1)
    PerTechnique technique_work{};  ///< that each technique took
};

/// No technique is sought less often: a few trials do not show what is rare.
inline constexpr double least_effort = 1.0 / 16.0;

/// The efforts with the least variance times work, x being their ratios to those of the trial, if a technique
/// of benefit B and work C changes the trial's variance by B (1 / x - 1), or, where B is negative, by B (1 -
/// x), and its work by C (x - 1). Efforts of techniques that took no work stay.
PerTechnique best_efforts(const PerTechnique& efforts, const EffortTrial& trial);

}  // namespace mote::integrators
