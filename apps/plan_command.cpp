// mote plan: what the scene requires, and what will run.
#include <cstdio>

#include "apps/command.h"
#include "apps/subcommands.h"

namespace mote::apps {

int plan_command(const SceneArguments& arguments) {
    const core::Registry registry = make_registry();
    core::LoadReport loaded;
    const auto scene = load(arguments, registry, &loaded);
    const core::Integrator& integrator = require_integrator(*scene, registry);
    const core::Requirements requirements = core::find_requirements(*scene);
    const std::string text = integrator.plan(*scene, requirements).to_text();
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    warn_about_scene(*scene, loaded);
    return exit_ok;
}

}  // namespace mote::apps
