// mote merge: partial films of one render to a picture, or to a larger partial film.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/partial_render.h"
#include "apps/picture_file.h"
#include "apps/subcommands.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "session/number_or_null.h"
#include "session/output_files.h"

namespace mote::apps {

namespace {

/// Films need no scene: what is known of the passes alone. The noise is that before filters of the whole
/// picture.
void write_statistics(const std::string& path, const MergedFilm& m) {
    const nlohmann::json j = {{"mote", MOTE_VERSION},           {"passes", m.film->pass_count()},
                              {"first_pass", m.first},          {"noise", number_or_null(m.film->noise())},
                              {"content", m.content_hash},      {"seed", m.render.seed},
                              {"rays", m.statistics.rays},      {"lookups", m.statistics.lookups},
                              {"seconds", m.statistics.seconds}};
    write_text(path, j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace

int merge_command(const MergeArguments& arguments) {
    std::vector<NamedFile> inputs;
    for (const std::string& part : arguments.parts) {
        require_input(part);
        inputs.push_back({"a partial film that is merged,", part});
    }
    const NamedFile outputs[] = {{"the output", arguments.output}, {"the statistics", arguments.stats}};
    check_outputs(outputs, inputs);
    MergedFilm merged = core::with_memory_for("the films", [&] { return merge_partials(arguments.parts); });
    if (extension_of(arguments.output) == ".film") {
        write_partial(arguments.output, merged);
        if (!arguments.stats.empty()) write_statistics(arguments.stats, merged);
        if (!arguments.quiet) std::fputs((arguments.output + "\n").c_str(), stdout);
        return 0;
    }
    if (merged.first > 0)
        throw core::InputError(
            fmt::format("a picture begins with pass 0, and '{}' with pass {}: give the parts before it too, "
                        "or write a .film",
                        core::printable(arguments.parts.front(), 300), merged.first));
    RenderArguments render = merged.render;
    if (!arguments.scene.empty()) render.scene.scene = arguments.scene;
    std::error_code ignored;
    if (!std::filesystem::exists(render.scene.scene, ignored))
        throw core::InputError(
            fmt::format("the scene '{}' that the films were rendered from is not there: --scene says "
                        "where it is",
                        core::printable(render.scene.scene, 300)));
    render.output = arguments.output, render.stats = arguments.stats, render.quiet = arguments.quiet;
    render.threads = arguments.threads, render.exposure = arguments.exposure;
    render.half = render.half || arguments.half;
    render.passes = merged.film->pass_count();
    render.command_line = arguments.command_line;
    render.merged = &merged;
    return render_command(render);
}

}  // namespace mote::apps
