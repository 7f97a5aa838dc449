// Results of the records of a trade: the error of every method as a curve over time, which points no other
// method beats, when an error is reached, and whether the bias is more than chance.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "trade/record.h"

namespace mote::trade {

/// Several seeds after the same number of passes, or all at their end.
struct CurvePoint {
    double passes = 0.0, wall = 0.0;                  ///< means over seeds
    double error = 0.0, lowest = 0.0, highest = 0.0;  ///< mean and range over seeds
    double error_se = unknown;  ///< of the mean: the reference's noise, and with two seeds or more their spread
    bool below_reference = false;
    bool on_front = false;
};

struct Curve {
    std::string method, integrator, settings;
    std::vector<CurvePoint> points;  ///< in order of time
    std::size_t seeds = 0;
    bool complete = false;  ///< every seed has ended
    // Means over seeds at the end of each.
    double passes = 0.0, wall = 0.0, cpu = 0.0, build = 0.0, relmse = unknown, relmse_trimmed = unknown;
    double lowest_wall = 0.0, highest_wall = 0.0;
    double bias = unknown,
           bias_se = unknown;  ///< from the passes' spread; with 4 seeds or more also from theirs
    std::uint64_t non_finite = 0;
    double peak_memory_mb = 0.0;
    bool peer = false;  ///< another renderer, from a *.peer.csv

    double error() const { return points.empty() ? unknown : points.back().error; }
    double error_se() const { return points.empty() ? unknown : points.back().error_se; }
    /// The error squared times seconds: an unbiased method keeps it, whatever time it is given.
    double inefficiency() const { return error() * error() * wall; }
};

/// One curve a method, in the order of their first records. `floor`: errors below are not judged.
std::vector<Curve> make_curves(std::span<const Record> records, double floor);

/// Marks the points that no point of any curve beats in both time and error. Points below the reference's
/// floor beat others, but are not marked: the reference cannot rank them.
void mark_pareto_front(std::vector<Curve>& curves);

/// Limits of the reference.
struct Judge {
    double floor = 0.0;       ///< errors below are not judged
    double bias_error = 0.0;  ///< standard error that its noise adds to every bias
};

/// Bias of more than three standard errors, those of the reference included.
bool bias_is_significant(const Curve& curve, double reference_bias_error);

struct Reach {
    enum class Kind {
        measured,         ///< seconds at which the curve falls below the error for good
        at_most,          ///< below from its first point on
        extrapolated,     ///< error ~ time^-1/2 from the last points
        never,            ///< the bias stays, and is larger or has flattened the curve
        unclear,          ///< not reached, and too few points, or they do not fall like time^-1/2
        below_reference,  ///< the reference cannot resolve it
    };
    Kind kind = Kind::unclear;
    double seconds = unknown;
    double slope = unknown;  ///< of log error over log time in the last points, where that decided
};

/// When `curve` reaches `error`.
Reach time_to_reach(const Curve& curve, double error, const Judge& judge);
/// "3.2 s", "~41 s (extrapolated)", "not with a bias of -4.2 %", ...
std::string to_text(const Reach& reach, const Curve& curve);

}  // namespace mote::trade
