// mote export: the scene in another renderer's words.
#include <cstdio>

#include "apps/command.h"
#include "apps/export/mitsuba_export.h"
#include "apps/subcommands.h"

namespace mote::apps {

int export_command(const ExportArguments& arguments) {
    const core::Registry registry = make_registry(arguments.scene.plugins);
    core::SceneDocument document = core::load_scene_elements(arguments.scene.scene, registry,
                                                             load_options(scene_changes(arguments.scene)));
    for (const std::string& text : document.approximations) std::printf("--lenient: %s\n", text.c_str());
    const MitsubaExport result = export_to_mitsuba(std::move(document), registry, arguments.scene.scene,
                                                   arguments.max_grid_megabytes * 1'000'000);
    write_export(result, arguments.output);
    for (const std::string& note : result.notes) std::printf("%s\n", note.c_str());
    std::printf("%s/scene.xml is written; dropped or changed: %zu (dropped.txt)\n", arguments.output.c_str(),
                result.notes.size());
    return exit_ok;
}

}  // namespace mote::apps
