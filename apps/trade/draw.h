// From the records of a folder to what people look at.
#pragma once

#include <string>
#include <vector>

#include "apps/trade/curves.h"
#include "apps/trade/folder.h"

namespace mote::apps::trade {

/// Errors that the table gives times for.
inline constexpr double errors_of_interest[] = {0.05, 0.02, 0.01};

/// Everything that plot, summary and page show.
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
/// One HTML file without references to others. `page_width`: of the pictures in it.
std::string page_html(const Results& results, const Folder& folder, int page_width);

/// Writes trade.svg, summary.json, trade.html and a JSON file beside every method's picture.
void draw(const Folder& folder, int page_width);

}  // namespace mote::apps::trade
