// From the command line to a loaded scene.
#include <cstdio>

#include "apps/placement_notes.h"
#include "apps/subcommands.h"
#include "core/loading/scene_loader.h"
#include "core/objects/error.h"
#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "media/register_media.h"

namespace mote::apps {

namespace {

void warn(const std::string& text) { std::fputs(("mote: " + text + "\n").c_str(), stderr); }

}  // namespace

core::Registry make_registry() {
    core::Registry registry;
    core::register_core(registry);
    media::register_media(registry);
    lights::register_lights(registry);
    integrators::register_integrators(registry);
    return registry;
}

std::vector<std::pair<std::string, std::string>> split_defines(const std::vector<std::string>& defines) {
    std::vector<std::pair<std::string, std::string>> split;
    for (const std::string& define : defines) {
        const auto equals = define.find('=');
        if (equals == std::string::npos || equals == 0)
            throw UsageError("-D " + core::printable(define) + ": expected name=value");
        split.emplace_back(define.substr(0, equals), define.substr(equals + 1));
    }
    return split;
}

core::LoadOptions load_options(const SceneArguments& arguments) {
    core::LoadOptions options;
    options.integrator = arguments.integrator, options.default_integrator = "mote_layers";
    options.lenient = arguments.lenient, options.frame = arguments.frame;
    options.defines = split_defines(arguments.defines);
    return options;
}

std::unique_ptr<core::Scene> load(const SceneArguments& arguments, const core::Registry& registry,
                                  core::LoadReport* report) {
    core::LoadOptions options = load_options(arguments);
    options.report = report;
    return core::load_scene(arguments.scene, registry, options);
}

void warn_about_scene(const core::Scene& scene, const core::LoadReport& report) {
    for (const std::string& text : report.approximations) warn("--lenient: " + text);
    for (const std::string& text : scene.parts().warnings) warn("warning: " + text);
    for (const std::string& text : placement_notes(scene)) warn("warning: " + text);
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
