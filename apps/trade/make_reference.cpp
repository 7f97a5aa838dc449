// A reference is an ordinary render that ends when it tells the smallest error to be judged by it from none.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "apps/command.h"
#include "apps/interruption.h"
#include "apps/output_files.h"
#include "apps/preview.h"
#include "apps/progress_line.h"
#include "apps/trade/reference.h"
#include "apps/trade/trade_command.h"
#include "core/film/film_image.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/integrator_maker.h"
#include "core/objects/error.h"
#include "session/reference_metadata.h"
#include "session/render_report.h"

namespace mote::apps::trade {

namespace {

namespace fs = std::filesystem;

void note(const std::string& text) { std::fputs(fmt::format("mote: {}\n", text).c_str(), stderr); }

void check_output(const std::string& path) {
    if (fs::path(path).extension() != ".exr")
        throw UsageError("the reference '" + core::printable(path) + "' does not end in .exr");
    const fs::path folder = fs::path(path).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !fs::is_directory(folder, ignored))
        throw core::InputError("cannot be written: there is no folder '" + folder.string() + "'", {path, 0});
}

std::vector<NamedFile> outputs_of(const TradeArguments& arguments) {
    const std::string& path = arguments.make_reference;
    return {{"the reference", path},
            {"its preview", fs::path(path).replace_extension(".png").string()},
            {"its checkpoint", path + ".checkpoint"}};
}

std::string verdict(double noise, double smallest, double resolve) {
    if (!std::isfinite(noise)) return "one pass says nothing about its own noise";
    return fmt::format(
        "noise {:.3g} %: it judges errors down to {:.3g} %{}", 100.0 * noise, 100.0 * smallest,
        smallest <= resolve
            ? ""
            : fmt::format(", not the {:.3g} % asked for; the same command renders on", 100.0 * resolve));
}

/// --setting NAME=VALUE as it would stand in a scene file: the manual page knows its element.
std::vector<core::IntegratorSetting> settings_of(const TradeArguments& arguments,
                                                 const core::Registry& registry, const std::string& type) {
    std::vector<core::IntegratorSetting> settings;
    const core::Manual* manual = registry.find(core::Category::integrator, type);
    for (const std::string& setting : arguments.settings) {
        const auto equals = setting.find('=');
        if (equals == std::string::npos || equals == 0)
            throw UsageError("--setting " + core::printable(setting) + ": expected name=value");
        const std::string name = setting.substr(0, equals);
        std::string tag = "string";  // of a name that is unknown, and refused as such
        if (manual)
            for (const core::Parameter& p : manual->parameters)
                if (p.name == name) tag = p.type;
        settings.push_back({name, tag, setting.substr(equals + 1), {"--setting " + setting, 0}});
    }
    return settings;
}

core::RenderRequest make_request(const TradeArguments& arguments, const core::Scene& scene,
                                 const std::string& type) {
    core::RenderRequest request;
    request.checkpoint_path = arguments.make_reference + ".checkpoint";
    std::vector<std::string> settings = {MOTE_VERSION, "reference", type};
    settings.insert(settings.end(), arguments.scene.defines.begin(), arguments.scene.defines.end());
    settings.insert(settings.end(), arguments.settings.begin(), arguments.settings.end());
    request.content_hash = core::content_hash(scene, settings);
    std::error_code ignored;
    if (arguments.fresh) fs::remove(request.checkpoint_path, ignored);
    request.resume = fs::exists(request.checkpoint_path, ignored);
    request.checkpoint_every_seconds = arguments.checkpoint_every;
    request.enough = [resolve = arguments.resolve](const core::Film& film) {
        return smallest_error(film) <= resolve;
    };
    request.stop.seconds = arguments.seconds;
    request.stop.passes = arguments.passes;
    return request;
}

core::RenderResult render_with_progress(const core::Scene& scene, const core::Integrator& integrator,
                                        core::RenderRequest& request, ProgressLine& progress) {
    request.progress = [&progress](const core::RenderProgress& p) { progress.update(p); };
    try {
        core::RenderResult result = core::render(scene, integrator, request);
        progress.end();
        return result;
    } catch (...) {
        progress.end();
        throw;
    }
}

}  // namespace

int make_reference(const TradeArguments& arguments) {
    check_output(arguments.make_reference);
    Interruption interruption;
    interruption.end_at_once_while("loading the scene");
    const int threads = arguments.threads > 0 ? arguments.threads : tbb::info::default_concurrency();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    const core::Registry registry = make_registry();
    core::LoadReport loaded;
    const auto scene = load({arguments.scene.scene, "", arguments.scene.defines, arguments.scene.lenient},
                            registry, &loaded);
    check_outputs(outputs_of(arguments), scene_inputs(scene->parts().input_files));
    const std::string content = scene_content(*scene, arguments.scene.defines);
    if (!arguments.fresh &&
        is_good_reference(arguments.make_reference, *scene, content, {arguments.resolve, false, false})) {
        if (!arguments.quiet)
            note(arguments.make_reference + " resolves this already (--fresh makes it anew)");
        if (arguments.announce) std::fputs((arguments.make_reference + "\n").c_str(), stdout);
        return exit_ok;
    }
    std::string type = arguments.scene.integrator;
    if (type.empty()) type = scene->has_media() ? "volpath" : "path";
    std::vector<std::string> warnings = scene->parts().warnings;
    warnings.insert(warnings.end(), loaded.approximations.begin(), loaded.approximations.end());
    const auto integrator =
        core::make_integrator(registry, *scene, type, settings_of(arguments, registry, type),
                              {"--integrator " + type, 0}, warnings);
    const core::Plan plan = integrator->plan(*scene, core::find_requirements(*scene));
    core::RenderRequest request = make_request(arguments, *scene, type);
    if (!arguments.quiet) {
        for (const std::string& warning : warnings) note("warning: " + warning);
        for (const std::string& line : plan.warnings()) note(line);
    }

    interruption.end_at_once_while("building", "nothing is lost");
    request.interrupted = &interruption.flag();
    request.building_is_over = [&] { interruption.end_at_once_while(nullptr); };
    ProgressLine progress(fmt::format("mote: reference of {} by {} that judges errors down to {:.3g} %",
                                      scene->parts().file, type, 100.0 * arguments.resolve),
                          arguments.quiet);
    const core::RenderResult result = render_with_progress(*scene, *integrator, request, progress);
    if (result.film.pass_count() == 0) {
        note("interrupted before the first pass was complete: there is nothing to write");
        return 128 + interruption.signal_number();
    }
    const double smallest = smallest_error(result.film);
    core::ImageChannels image = core::film_image(result.film);
    image.metadata = picture_metadata(
        {*scene, plan, result, request.content_hash, content, request.seed, threads, arguments.command_line});
    core::write_exr(arguments.make_reference, image);
    write_preview(fs::path(arguments.make_reference).replace_extension(".png").string(), image);
    if (result.statistics.non_finite_samples > 0)
        note(fmt::format("WARNING: {} pixel samples were NaN or infinite and count as black",
                         result.statistics.non_finite_samples));
    if (!arguments.quiet)
        note(fmt::format("{} passes, {}", result.film.pass_count(),
                         verdict(result.film.noise(), smallest, arguments.resolve)));
    if (result.interrupted) {
        note("interrupted: the same command continues");
        return 128 + interruption.signal_number();
    }
    std::error_code ignored;
    if (smallest <= arguments.resolve) fs::remove(request.checkpoint_path, ignored);
    if (arguments.announce) std::fputs((arguments.make_reference + "\n").c_str(), stdout);
    return exit_ok;
}

}  // namespace mote::apps::trade
