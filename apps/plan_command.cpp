// mote plan: what the scene requires, and what will run.
#include <cstdio>

#include "apps/command.h"
#include "apps/subcommands.h"

namespace mote::apps {

int plan_command(const SceneArguments& arguments) {
    const LoadedScene scene = load(arguments);
    std::fputs(scene.plan().to_text().c_str(), stdout);
    std::fflush(stdout);
    warn_about(scene);
    return exit_ok;
}

}  // namespace mote::apps
