// mote trade: what its command line gives.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trade/trade.h"

namespace CLI {
class App;
}

namespace mote::apps {

struct TradeArguments {
    trade::Settings settings;
    trade::ReferenceSettings make_reference;               ///< path "": a trade is measured
    std::vector<std::string> defines, reference_settings;  ///< "name=value"
    bool redraw = false, quiet = false;
};

/// Adds the subcommand to the command line; `action` is what it will do.
void add_trade(CLI::App& app, TradeArguments& arguments, std::function<int()>& action);

int trade_command(const TradeArguments& arguments);

}  // namespace mote::apps
