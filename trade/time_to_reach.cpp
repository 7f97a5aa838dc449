// When a curve reaches an error: read off where it was measured, and beyond that only where its last points
// fall like time^-1/2, as the error of a mean of independent passes does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trade/curves.h"

namespace mote::trade {

namespace {

constexpr std::size_t fitted_points = 4, fewest_points = 3;
constexpr double slope_of_noise = -0.5, flattest_slope = -0.35;  // flatter ones are on their way to a bias

std::vector<CurvePoint> judged_points(const Curve& curve) {
    std::vector<CurvePoint> points;
    for (const CurvePoint& p : curve.points)
        if (!p.below_reference) points.push_back(p);
    return points;
}

// Straight between two points in log-log, as the plot draws it.
double crossing(const CurvePoint& above, const CurvePoint& below, double error) {
    const double f = std::log(above.error / error) / std::log(above.error / below.error);
    return above.wall * std::pow(below.wall / above.wall, f);
}

// Least squares of log error over the log of the seconds that passes took: building does not lessen errors.
double last_slope(const std::vector<CurvePoint>& points, double build) {
    const std::size_t n = std::min(points.size(), fitted_points), from = points.size() - n;
    double mx = 0.0, my = 0.0, xy = 0.0, xx = 0.0;
    const auto x = [&](std::size_t i) { return std::log(std::max(points[i].wall - build, 1e-9)); };
    for (std::size_t i = from; i < points.size(); ++i)
        mx += x(i) / double(n), my += std::log(points[i].error) / double(n);
    for (std::size_t i = from; i < points.size(); ++i) {
        xy += (x(i) - mx) * (std::log(points[i].error) - my);
        xx += (x(i) - mx) * (x(i) - mx);
    }
    return xx > 0.0 ? xy / xx : 0.0;
}

Reach beyond(const Curve& curve, const std::vector<CurvePoint>& points, double error, bool biased) {
    using Kind = Reach::Kind;
    if (points.size() < fewest_points) return {Kind::unclear, unknown, unknown};
    const double build = std::isnan(curve.build) ? 0.0 : curve.build;
    const double slope = last_slope(points, build);
    if (slope > flattest_slope) return {biased ? Kind::never : Kind::unclear, unknown, slope};
    const CurvePoint& last = points.back();
    const double factor = std::pow(error / last.error, 1.0 / slope_of_noise);
    return {Kind::extrapolated, build + (last.wall - build) * factor, slope};
}

std::string seconds_text(double seconds) {
    if (seconds >= 36000.0) return fmt::format("{:.3g} h", seconds / 3600.0);
    return seconds >= 100.0 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.3g} s", seconds);
}

}  // namespace

Reach time_to_reach(const Curve& curve, double error, const Judge& judge) {
    using Kind = Reach::Kind;
    const bool biased = bias_is_significant(curve, judge.bias_error);
    // An error is never below its bias.
    if (biased && std::fabs(curve.bias) >= error) return {Kind::never, unknown, unknown};
    if (error < judge.floor * (1.0 - 1e-9)) return {Kind::below_reference, unknown, unknown};
    const std::vector<CurvePoint> points = judged_points(curve);
    // The first point from which on all are at the error or below.
    std::size_t first = points.size();
    while (first > 0 && points[first - 1].error <= error) --first;
    if (first == points.size()) {
        // How far below the floor a point lies is not judged, but that it lies below is.
        for (const CurvePoint& p : curve.points)
            if (p.below_reference && (points.empty() || p.wall > points.back().wall))
                return {Kind::at_most, p.wall, unknown};
        return beyond(curve, points, error, biased);
    }
    if (first == 0) return {Kind::at_most, points.front().wall, unknown};
    return {Kind::measured, crossing(points[first - 1], points[first], error), unknown};
}

std::string to_text(const Reach& reach, const Curve& curve) {
    switch (reach.kind) {
        case Reach::Kind::measured:
            return seconds_text(reach.seconds);
        case Reach::Kind::at_most:
            return "at most " + seconds_text(reach.seconds);
        case Reach::Kind::extrapolated:
            return "~" + seconds_text(reach.seconds) + " (extrapolated)";
        case Reach::Kind::never:
            return fmt::format("not with a bias of {:+.2g} %", 100.0 * curve.bias);
        case Reach::Kind::below_reference:
            return "the reference is too noisy";
        case Reach::Kind::unclear:
            break;
    }
    if (std::isnan(reach.slope)) return "not reached (too few points)";
    return fmt::format("not reached (falls like t^{:.2f})", reach.slope);
}

}  // namespace mote::trade
