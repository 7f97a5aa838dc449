// mote trade: what its command line gives.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/subcommands.h"

namespace CLI {
class App;
}

namespace mote::apps {

struct TradeArguments {
    SceneArguments scene;  ///< integrator: of the reference that is made
    std::string reference, make_reference, methods, output;
    std::vector<std::string> settings;  ///< "name=value" of the integrator of the reference that is made
    std::optional<double> seconds;
    std::optional<std::uint32_t> passes, seeds;
    double resolve = 0.01, checkpoint_every = 60.0;
    int threads = 0, page_width = 640;
    bool announce = true;  ///< the reference that was made
    bool redraw = false, fresh = false, trust_reference = false, force_reference = false, quiet = false;
    std::vector<std::string> command_line;
};

/// Adds the subcommand to the command line; `action` is what it will do.
void add_trade(CLI::App& app, TradeArguments& arguments, std::function<int()>& action);

int trade_command(const TradeArguments& arguments);

namespace trade {
/// --make-reference: renders until the reference can judge errors of `resolve`, or the time is up.
int make_reference(const TradeArguments& arguments);
}  // namespace trade

}  // namespace mote::apps
