// From the command line to a loaded scene.
#include <cstdio>

#include "apps/subcommands.h"
#include "core/objects/error.h"

namespace mote::apps {

std::vector<std::pair<std::string, std::string>> split_defines(const std::vector<std::string>& defines,
                                                               const std::string& option) {
    std::vector<std::pair<std::string, std::string>> split;
    for (const std::string& define : defines) {
        const auto equals = define.find('=');
        if (equals == std::string::npos || equals == 0)
            throw UsageError(option + " " + core::printable(define) + ": expected name=value");
        split.emplace_back(define.substr(0, equals), define.substr(equals + 1));
    }
    return split;
}

SceneChanges scene_changes(const SceneArguments& arguments) {
    return {arguments.integrator, split_defines(arguments.defines), arguments.lenient, arguments.frame,
            arguments.plugins};
}

LoadedScene load(const SceneArguments& arguments, std::shared_ptr<const core::Registry> registry) {
    const SceneChanges changes = scene_changes(arguments);
    return registry ? LoadedScene::from_file(arguments.scene, changes, std::move(registry))
                    : LoadedScene::from_file(arguments.scene, changes);
}

void warn_about(const LoadedScene& scene) {
    for (const std::string& line : scene.warnings()) std::fputs(("mote: " + line + "\n").c_str(), stderr);
}

}  // namespace mote::apps
