// Results of each method as data: summary.json, and the order of everything.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/metrics/metrics.h"
#include "session/number_or_null.h"
#include "trade/draw.h"

namespace mote::trade {

using session::number_or_null;

namespace {

using nlohmann::json;

/// In the order of Reach::Kind.
constexpr const char* kind_names[] = {"measured", "at_most", "extrapolated",
                                      "never",    "unclear", "below_reference"};

json points_json(const Curve& curve) {
    json points = json::array();
    for (const CurvePoint& p : curve.points)
        points.push_back({{"passes", p.passes},
                          {"wall_s", p.wall},
                          {"error", p.error},
                          {"error_se", number_or_null(p.error_se)},
                          {"error_lowest", p.lowest},
                          {"error_highest", p.highest},
                          {"below_reference", p.below_reference},
                          {"on_front", p.on_front}});
    return points;
}

json method_json(const Results& results, const Curve& c) {
    json reach = json::array();
    for (std::size_t i = 0; const Reach& r : results.reaches(c))
        reach.push_back({{"error", errors_of_interest[i++]},
                         {"kind", kind_names[int(r.kind)]},
                         {"seconds", number_or_null(r.seconds)},
                         {"text", to_text(r, c)}});
    return {{"name", c.method},
            {"integrator", c.integrator},
            {"settings", c.settings},
            {"peer", c.peer},
            {"seeds", c.seeds},
            {"passes", c.passes},
            {"wall_s", c.wall},
            {"wall_s_range", {c.lowest_wall, c.highest_wall}},
            {"cpu_s", number_or_null(c.cpu)},
            {"build_s", number_or_null(c.build)},
            {"error", number_or_null(c.error())},
            {"error_se", number_or_null(c.error_se())},
            {"relmse", number_or_null(c.relmse)},
            {"relmse_trimmed", number_or_null(c.relmse_trimmed)},
            {"bias", number_or_null(c.bias)},
            {"bias_se", number_or_null(c.bias_se)},
            {"bias_significant", bias_is_significant(c, results.judge.bias_error)},
            {"inefficiency", number_or_null(c.inefficiency())},
            {"non_finite", c.non_finite},
            {"peak_memory_mb", number_or_null(c.peak_memory_mb)},
            {"on_front", !results.front_text(c).empty()},
            {"time_to_reach", reach},
            {"points", points_json(c)}};
}

std::string definition_of_error() {
    const auto metrics = core::metric_definitions();
    const auto error = std::find_if(metrics.begin(), metrics.end(), [](const core::MetricDefinition& m) {
        return std::string_view(m.name) == "error";
    });
    return fmt::format("{}; d = image - reference r; in points the mean over seeds", error->definition);
}

}  // namespace

std::string Results::title() const {
    const std::filesystem::path scene = facts.value("scene", std::string("?"));
    return "Error against time: " + scene.filename().string();
}

std::string Results::front_text(const Curve& curve) const {
    double from = unknown, to = unknown;
    for (const CurvePoint& p : curve.points) {
        if (!p.on_front) continue;
        if (std::isnan(from)) from = p.wall;
        to = p.wall;
    }
    if (std::isnan(from)) return "";
    return from == to ? fmt::format("at {:.3g} s", from) : fmt::format("{:.3g} s to {:.3g} s", from, to);
}

std::vector<Reach> Results::reaches(const Curve& curve) const {
    std::vector<Reach> result;
    for (const double e : errors_of_interest) result.push_back(time_to_reach(curve, e, judge));
    return result;
}

Results collect(const Folder& folder) {
    Results results;
    results.facts = folder.facts();
    const auto reference = [&](const char* key) {
        const json& r = results.facts.at("reference");
        return r.contains(key) && r[key].is_number() ? r[key].get<double>() : 0.0;
    };
    results.judge = {reference("floor"), reference("bias_error")};
    results.curves = make_curves(folder.records(), results.judge.floor);
    // Colours follow the methods file, not the order in which methods ended.
    const json& methods = results.facts.at("methods");
    const auto place = [&](const Curve& c) {
        std::size_t i = 0;
        while (i < methods.size() && methods[i].at("name") != c.method) ++i;
        return i;
    };
    std::stable_sort(results.curves.begin(), results.curves.end(),
                     [&](const Curve& a, const Curve& b) { return place(a) < place(b); });
    const auto seeds = results.facts.at("seeds").size();
    results.complete = results.curves.size() == methods.size() &&
                       std::all_of(results.curves.begin(), results.curves.end(),
                                   [&](const Curve& c) { return c.complete && c.seeds == seeds; });
    for (Curve& c : make_curves(folder.peer_records(), results.judge.floor)) {
        c.peer = true;
        results.curves.push_back(std::move(c));
    }
    mark_pareto_front(results.curves);
    return results;
}

json summary_json(const Results& results) {
    json methods = json::array();
    for (const Curve& c : results.curves) methods.push_back(method_json(results, c));
    return {
        {"facts", results.facts},
        {"complete", results.complete},
        {"definitions",
         {{"error", definition_of_error()},
          {"error_se",
           "standard error of error from the noise of the reference, which all seeds share, and with two "
           "seeds or more from their spread"},
          {"relmse", "mean over pixels and channels of d^2 / (r^2 + 0.01), d = image - reference r"},
          {"relmse_trimmed", "relMSE without the 0.1 % of pixels where it is largest"},
          {"bias", "sum w <r, d> / sum w |r|^2, signed; mean over seeds; never more than error"},
          {"bias_se",
           "standard error of bias from the spread of the passes' biases; with four seeds or more at least "
           "that from the spread of the seeds"},
          {"bias_significant", "more than three standard errors, the reference's own among them"},
          {"wall_s", "seconds of build, passes and one finish"},
          {"cpu_s", "the same as seconds of all processors together"},
          {"build_s", "the part of wall_s before the first pass"},
          {"inefficiency", "error squared times wall seconds"},
          {"peak_memory_mb", "of the process so far, with all methods alive"},
          {"time_to_reach",
           "measured: where the curve falls below for good; extrapolated: error falls like time^-1/2 from "
           "the last points; never: the bias stays"}}},
        {"methods", methods}};
}

void draw(const Folder& folder, int page_width) {
    const Results results = collect(folder);
    folder.write("trade.svg", plot_svg(results.curves, results.judge.floor, results.title()));
    const auto text = [](const json& j) {
        return j.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
    };
    const json summary = summary_json(results);
    folder.write("summary.json", text(summary));
    for (const json& m : results.facts.at("methods"))
        for (const json& s : summary.at("methods"))
            if (s.at("name") == m.at("name"))
                folder.write(m.at("slug").get<std::string>() + ".json", text(s));
    folder.write("trade.txt", text_table(results));
    folder.write("trade.html", page_html(results, folder, page_width));
}

}  // namespace mote::trade
