// From the command line to a loaded scene.
#include <cstdio>

#include "apps/subcommands.h"
#include "core/formats/xml/scene_loader.h"
#include "core/objects/error.h"

namespace mote::apps {

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

SceneChanges scene_changes(const SceneArguments& arguments) {
    return {arguments.integrator, split_defines(arguments.defines), arguments.lenient, arguments.frame};
}

std::unique_ptr<core::Scene> load(const SceneArguments& arguments, const core::Registry& registry,
                                  core::LoadReport* report) {
    core::LoadOptions options = load_options(scene_changes(arguments));
    options.report = report;
    return core::load_scene(arguments.scene, registry, options);
}

void warn_about_scene(const core::Scene& scene, const core::LoadReport& report) {
    for (const std::string& line : scene_warnings(scene, report))
        std::fputs(("mote: " + line + "\n").c_str(), stderr);
}

}  // namespace mote::apps
