// The measuring half of a trade: methods take turns, and every power of two of passes is judged.
#pragma once

#include "trade/contestant.h"
#include "trade/folder.h"
#include "trade/trade.h"

namespace mote::trade {

struct Plan {
    const core::Scene& scene;
    const std::vector<Method>& methods;
    const Reference& reference;
    Limits limits;
    std::vector<std::uint64_t> seeds;
    std::string content;  ///< scene_content()
    int threads = 1;
    std::vector<std::string> render_command;  ///< "mote render SCENE -D ...", what the command line changed
    double checkpoint_every = 60.0;           ///< seconds
};

/// Index of the method whose turn it is: the one with the least wall time among those still `running`. All of
/// them then are about equally far at any moment, and a machine that slows down slows them all.
std::size_t next_turn(const std::vector<double>& seconds, const std::vector<bool>& running);

/// The seeds 1, 2, ... without the one of the reference, which would share its random numbers.
std::vector<std::uint64_t> seeds_beside(const std::optional<std::uint64_t>& reference, std::uint32_t count);

/// The command that renders a method's picture with the same bits; --passes is left to the caller.
std::vector<std::string> render_command_of(const Plan& plan, const Method& method, std::uint64_t seed);

/// Continues where the folder's records and checkpoints end. Returns false when interrupted; everything that
/// is needed to continue has been written then.
bool run(const Plan& plan, Folder& folder, Host& host);

}  // namespace mote::trade
