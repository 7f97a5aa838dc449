// The comparison of a viewer as the page and the records of a trade.
#pragma once

#include "viewer/comparison.h"

namespace mote::apps {

class TradePage final : public viewer::ComparisonPage {
  public:
    /// "trade.html", whose pictures and tables are those of `mote trade`, and "trade.csv".
    std::vector<std::pair<std::string, std::string>> files(
        const viewer::Comparison& comparison) const override;
};

}  // namespace mote::apps
