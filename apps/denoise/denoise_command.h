// mote denoise: what its command line gives.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace mote::apps {

struct DenoiseArguments {
    std::string input, output;      ///< with # for the number of a frame: a sequence
    std::string method = "oidn";    ///< or "bmfr"
    std::optional<float> exposure;  ///< of the preview [stops]; none: it adapts
    int threads = 0;                ///< 0: one for every core
    bool half = false, quiet = false;
};

/// Adds the subcommand to the command line; `action` is what it will do.
void add_denoise(CLI::App& app, DenoiseArguments& arguments, std::function<int()>& action);

}  // namespace mote::apps
