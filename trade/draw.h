// From the records of a folder to plot, tables and page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "trade/curves.h"
#include "trade/folder.h"

namespace mote::trade {

/// Errors that the table gives times for.
inline constexpr double errors_of_interest[] = {0.05, 0.02, 0.01};

/// Contents of plot, summary and page.
struct Results {
    nlohmann::json facts;
    std::vector<Curve> curves;  ///< in the order of the methods file, then peers; the front is marked
    Judge judge;
    bool complete = false;  ///< every method ended with every seed

    std::string title() const;
    /// "8.3 s to 60 s", or "" where the curve has no point on the front.
    std::string front_text(const Curve& curve) const;
    std::vector<Reach> reaches(const Curve& curve) const;
};

/// Records and peers of the folder. Throws InputError for a damaged file.
Results collect(const Folder& folder);

nlohmann::json summary_json(const Results& results);
/// The table for a terminal and for mails, one line a method: passes, seconds, error, bias, times to errors,
/// and the front. Columns are aligned.
std::string text_table(const Results& results);
/// An SVG image, log-log: for every curve its mean over seeds with the range as a band, the Pareto front
/// behind them, and the smallest error that the reference can judge (`floor`, 0 for none) as a line. Curves
/// are distinguished by colour, marker and a label at their end. Text is escaped.
std::string plot_svg(std::span<const Curve> curves, double floor, const std::string& title);
/// Colour of each curve in the plot: the first one of an integrator has the same in all plots (Okabe and Ito
/// 2008: safe for the colour-blind).
std::vector<std::string> curve_colours(std::span<const Curve> curves);
/// Text made safe for XML and HTML.
std::string escaped(const std::string& text);
/// One HTML file without references to others. `page_width`: of the pictures in it.
std::string page_html(const Results& results, const Folder& folder, int page_width);

/// Writes trade.svg, summary.json, trade.html and a JSON file beside every method's picture.
void draw(const Folder& folder, int page_width);

}  // namespace mote::trade
