// Curves from records, the Pareto front, and the significance of a bias.
#include "trade/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace mote::trade {

namespace {

using Seeds = std::map<std::uint64_t, std::vector<const Record*>>;

double mean_of(const std::vector<const Record*>& records, double Record::*member) {
    double sum = 0.0;
    for (const Record* r : records) sum += r->*member;
    return sum / double(records.size());
}

/// Standard error of a mean over seeds. They share the reference, so the mean has as much of its noise as
/// each.
double error_se_of(const std::vector<const Record*>& seeds, double mean) {
    const double reference = mean_of(seeds, &Record::error_se), n = double(seeds.size());
    if (seeds.size() < 2) return reference;
    double squares = 0.0;
    for (const Record* r : seeds) squares += (r->error - mean) * (r->error - mean);
    return std::hypot(std::isnan(reference) ? 0.0 : reference, std::sqrt(squares / (n - 1.0) / n));
}

CurvePoint point_of(const std::vector<const Record*>& records, double floor) {
    CurvePoint p;
    p.wall = mean_of(records, &Record::wall), p.error = mean_of(records, &Record::error);
    p.error_se = error_se_of(records, p.error);
    p.lowest = std::numeric_limits<double>::infinity(), p.highest = 0.0;
    for (const Record* r : records) {
        p.passes += double(r->passes) / double(records.size());
        p.lowest = std::min(p.lowest, r->error), p.highest = std::max(p.highest, r->error);
    }
    p.below_reference = p.error < floor;
    return p;
}

bool usable(const Record& r) { return std::isfinite(r.error) && r.error > 0.0; }

/// The last record of every seed.
std::vector<const Record*> ends_of(const Seeds& seeds) {
    std::vector<const Record*> ends;
    for (const auto& [seed, records] : seeds) ends.push_back(records.back());
    return ends;
}

void add_points(Curve& curve, const Seeds& seeds, double floor) {
    std::map<std::uint32_t, std::vector<const Record*>> by_passes;
    std::vector<const Record*> ends = ends_of(seeds);
    for (const auto& [seed, records] : seeds)
        for (const Record* r : records)
            if (usable(*r)) by_passes[r->passes].push_back(r);
    // A point where seeds are missing would show the change of the company, not of the error.
    for (const auto& [passes, records] : by_passes)
        if (records.size() == seeds.size()) curve.points.push_back(point_of(records, floor));
    if (!std::all_of(ends.begin(), ends.end(), [](const Record* r) { return usable(*r); })) return;
    const CurvePoint end = point_of(ends, floor);
    // Ends differ by a few passes when time was the limit; a common point may already lie beyond their mean.
    while (!curve.points.empty() &&
           (curve.points.back().passes >= end.passes || curve.points.back().wall >= end.wall))
        curve.points.pop_back();
    curve.points.push_back(end);
}

void add_ends(Curve& curve, const Seeds& seeds) {
    const std::vector<const Record*> ends = ends_of(seeds);
    const double n = double(ends.size());
    double squares = 0.0, spread = 0.0;
    curve.seeds = ends.size(), curve.complete = true;
    curve.wall = mean_of(ends, &Record::wall), curve.cpu = mean_of(ends, &Record::cpu);
    curve.build = mean_of(ends, &Record::build), curve.relmse = mean_of(ends, &Record::relmse);
    curve.relmse_trimmed = mean_of(ends, &Record::relmse_trimmed), curve.bias = mean_of(ends, &Record::bias);
    curve.lowest_wall = std::numeric_limits<double>::infinity();
    for (const Record* r : ends) {
        curve.passes += double(r->passes) / n;
        curve.lowest_wall = std::min(curve.lowest_wall, r->wall);
        curve.highest_wall = std::max(curve.highest_wall, r->wall);
        curve.non_finite += r->non_finite;
        curve.peak_memory_mb = std::fmax(curve.peak_memory_mb, r->peak_memory_mb);
        curve.complete = curve.complete && r->final;
        squares += r->bias_se * r->bias_se, spread += (r->bias - curve.bias) * (r->bias - curve.bias);
    }
    curve.bias_se = std::sqrt(squares) / n;
    // With rare bright events the passes of one seed say too little; few seeds say nothing at all.
    if (n >= 4.0) curve.bias_se = std::max(curve.bias_se, std::sqrt(spread / (n - 1.0) / n));
}

bool beats(const CurvePoint& a, const CurvePoint& b) {
    return a.wall <= b.wall && a.error <= b.error && (a.wall < b.wall || a.error < b.error);
}

}  // namespace

std::vector<Curve> make_curves(std::span<const Record> records, double floor) {
    std::vector<std::string> order;
    std::map<std::string, Seeds> methods;
    for (const Record& r : records) {
        if (!methods.count(r.method)) order.push_back(r.method);
        methods[r.method][r.seed].push_back(&r);
    }
    std::vector<Curve> curves;
    for (const std::string& name : order) {
        Seeds& seeds = methods[name];
        for (auto& [seed, list] : seeds)
            std::sort(list.begin(), list.end(),
                      [](const Record* a, const Record* b) { return a->passes < b->passes; });
        Curve curve;
        curve.method = name;
        const Record& first = *seeds.begin()->second.front();
        curve.integrator = first.integrator, curve.settings = first.settings;
        add_points(curve, seeds, floor);
        add_ends(curve, seeds);
        curves.push_back(std::move(curve));
    }
    return curves;
}

void mark_pareto_front(std::vector<Curve>& curves) {
    std::vector<CurvePoint*> all;
    for (Curve& curve : curves)
        for (CurvePoint& p : curve.points) all.push_back(&p);
    for (CurvePoint* p : all)
        p->on_front = !p->below_reference && std::none_of(all.begin(), all.end(),
                                                          [&](const CurvePoint* o) { return beats(*o, *p); });
}

bool bias_is_significant(const Curve& curve, double reference_bias_error) {
    // Unknown standard errors are NaN, and no comparison with NaN holds.
    return std::fabs(curve.bias) > 3.0 * std::hypot(curve.bias_se, reference_bias_error);
}

}  // namespace mote::trade
