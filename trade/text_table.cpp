#include "trade/draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mote::trade {

namespace {

using Cells = std::vector<std::string>;

std::string with_error(double value, double error, const char* format) {
    if (!std::isfinite(value)) return "unknown";
    const std::string text = fmt::format(fmt::runtime(format), 100.0 * value);
    return text + (std::isfinite(error) ? fmt::format(" +- {:.2g} %", 100.0 * error) : " %");
}

Cells row_of(const Results& results, const Curve& c) {
    Cells row = {c.method, fmt::format("{:.3g}", c.passes), fmt::format("{:.3g} s", c.wall),
                 with_error(c.error(), c.error_se(), "{:.3g}"), with_error(c.bias, c.bias_se, "{:+.2g}")};
    if (bias_is_significant(c, results.judge.bias_error)) row.back() += " (!)";
    for (const Reach& r : results.reaches(c)) row.push_back(to_text(r, c));
    const std::string front = results.front_text(c);
    row.push_back(front.empty() ? "no" : front);
    return row;
}

/// Characters, not bytes: all but the continuations of UTF-8.
std::size_t length_of(const std::string& text) {
    return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string text_table(const Results& results) {
    std::vector<Cells> rows = {{"method", "passes", "wall", "error", "bias"}};
    for (const double e : errors_of_interest) rows[0].push_back(fmt::format("to {:g} %", 100.0 * e));
    rows[0].push_back("front");
    for (const Curve& c : results.curves) rows.push_back(row_of(results, c));
    std::vector<std::size_t> widths(rows[0].size(), 0);
    for (const Cells& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], length_of(row[i]));
    std::string text;
    for (const Cells& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line += row[i] + std::string(widths[i] - length_of(row[i]) + 2, ' ');
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    const bool several =
        std::any_of(results.curves.begin(), results.curves.end(), [](const Curve& c) { return c.seeds > 1; });
    const auto& reference = results.facts.at("reference");
    if (results.judge.floor > 0.0)
        text += fmt::format(
            "\nThe reference has a noise of {:.2g} %, which is subtracted; it judges errors down to {:.2g} "
            "%.\n"
            "+-: one standard error; of the error by the reference's noise{}.\n"
            "(!): more than three standard errors, the reference's own among them. Error, bias and noise: "
            "docs/testing.md.\n",
            100.0 * reference.value("noise", 0.0), 100.0 * results.judge.floor,
            several ? " and the spread of the seeds" : "");
    else
        text += "\nHow noisy the reference is, is not known.\n";
    return text;
}

}  // namespace mote::trade
