// mote ssbc: what its command line gives.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/subcommands.h"
#include "screenspace/ssbc/ssbc.h"
#include "screenspace/ssbc/ssbc_picture.h"

namespace CLI {
class App;
}

namespace mote::apps {

struct SsbcArguments {
    std::string input, output;
    float bound = 0.0f;    ///< 0: as the picture says
    SceneArguments scene;  ///< "": surfaces come from the picture's channels
    screenspace::SsbcChannels channels;
    screenspace::SsbcSettings settings;
    int layers = 1;  ///< of surfaces along a ray; hidden ones need a scene
    bool flat = false, half = false;
    bool replace = false;  ///< a compensation that the picture holds
};

/// Adds the subcommand to the command line; `action` is what it will do.
void add_ssbc(CLI::App& app, SsbcArguments& arguments, std::function<int()>& action);

}  // namespace mote::apps
