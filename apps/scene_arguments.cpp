// From the command line to a loaded scene.
#include "apps/subcommands.h"
#include "core/loading/scene_loader.h"
#include "core/objects/error.h"
#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "media/register_media.h"

namespace mote::apps {

core::Registry make_registry() {
    core::Registry registry;
    core::register_core(registry);
    media::register_media(registry);
    lights::register_lights(registry);
    integrators::register_integrators(registry);
    return registry;
}

core::LoadOptions load_options(const SceneArguments& arguments) {
    core::LoadOptions options;
    options.integrator = arguments.integrator;
    for (const std::string& define : arguments.defines) {
        const auto equals = define.find('=');
        if (equals == std::string::npos || equals == 0)
            throw UsageError("-D " + core::printable(define) + ": expected name=value");
        options.defines.emplace_back(define.substr(0, equals), define.substr(equals + 1));
    }
    return options;
}

std::unique_ptr<core::Scene> load(const SceneArguments& arguments, const core::Registry& registry) {
    return core::load_scene(arguments.scene, registry, load_options(arguments));
}

const core::Integrator& require_integrator(const core::Scene& scene, const core::Registry& registry) {
    if (scene.integrator()) return *scene.integrator();
    std::string known;
    for (const std::string& type : registry.types(core::Category::integrator))
        known += (known.empty() ? "" : ", ") + type;
    throw core::InputError("the scene names no integrator: choose one with --integrator (" + known + ")",
                           {scene.parts().file, 0});
}

}  // namespace mote::apps
