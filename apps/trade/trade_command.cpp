// mote trade: everything is read and checked before the first pass; then methods take turns; then it draws.
#include "apps/trade/trade_command.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "apps/command.h"
#include "apps/number_options.h"
#include "apps/output_files.h"
#include "apps/trade/default_methods.h"
#include "apps/trade/draw.h"
#include "apps/trade/run.h"
#include "core/files/checksum.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/scene_element.h"
#include "core/objects/error.h"
#include "session/denoise/denoised_layer.h"
#include "session/reference_metadata.h"
#include "session/render_report.h"

namespace mote::apps {

namespace {

using nlohmann::json;
using namespace trade;

constexpr const char* automatic_reference = "automatic_reference.exr";
constexpr double seconds_of_automatic_reference = 120.0;  ///< where passes are the limit

void note(const std::string& text) { std::fputs(fmt::format("mote: {}\n", text).c_str(), stderr); }

void check_usage(const TradeArguments& a) {
    const auto require = [](bool given, const std::string& option) {
        if (!given) throw UsageError("mote trade needs " + option);
    };
    if (a.redraw) return require(!a.output.empty(), "-o DIR");
    require(!a.scene.scene.empty(), "a SCENE");
    if (!a.make_reference.empty()) return;
    if (!a.scene.integrator.empty())
        throw UsageError("--integrator is for --make-reference; the methods name theirs");
}

Limits limits_of(const TradeArguments& a, const MethodsFile& file) {
    Limits limits{file.seconds, file.passes};
    // What the command line says replaces what the file says.
    if (a.seconds || a.passes) limits = {a.seconds, a.passes};
    if (!limits.seconds && !limits.passes)
        throw core::InputError(
            "it says neither 'time' nor 'passes', nor does the command line (--time, --passes)",
            {a.methods, 0});
    return limits;
}

/// What the command line leaves open: the folder, and in it a reference of our own.
TradeArguments with_defaults(TradeArguments a) {
    if (a.output.empty()) a.output = std::filesystem::path(a.scene.scene).stem().string() + "_trade";
    if (a.reference.empty()) a.reference = (std::filesystem::path(a.output) / automatic_reference).string();
    return a;
}

/// Renders the reference that nobody gave, for as long as all methods together take at most, or goes on with
/// it. Returns an exit code.
int make_automatic_reference(const TradeArguments& a, const MethodsFile& file, const Limits& limits) {
    std::filesystem::create_directories(a.output);
    TradeArguments reference = a;
    reference.make_reference = a.reference, reference.announce = false, reference.passes.reset();
    const double shares = double(file.methods.size()) * a.seeds.value_or(file.seeds);
    reference.seconds = limits.seconds ? shares * *limits.seconds : seconds_of_automatic_reference;
    return make_reference(reference);
}

std::string pixels_hash(const Reference& reference) {
    const auto bytes = std::as_bytes(std::span(reference.pixels));
    return fmt::format("{:016x}", core::checksum(bytes));
}

/// What the scene's integrators set, for the page.
std::string inherited_text(const core::Scene& scene) {
    std::string text;
    const auto add = [&](const core::Element& element, const std::string& of) {
        for (const core::Element& c : element.children)
            text += (text.empty() ? "" : " ") + of + c.get("name") + "=" + c.get("value");
    };
    if (const auto& element = scene.parts().integrator_element) add(*element, "");
    for (const auto& element : scene.parts().further_integrators) add(*element, element->get("type") + ".");
    return text;
}

json optional_json(const auto& value) { return value ? json(*value) : json(nullptr); }

json methods_json(const Plan& plan) {
    json methods = json::array();
    for (const Method& m : plan.methods)
        methods.push_back({{"name", m.name},
                           {"slug", m.slug},
                           {"integrator", m.type},
                           {"settings", m.settings},
                           {"command", render_command_of(plan, m, plan.seeds.front())}});
    return methods;
}

Identity identity_of(const TradeArguments& a, const Plan& plan) {
    Identity identity;
    json methods = json::array();
    for (const Method& m : plan.methods) methods.push_back({m.name, m.type, m.settings});
    identity.inputs = {{"mote", MOTE_VERSION},
                       {"error", "relative_error.h"},  // records of another measure are not to be continued
                       {"scene", plan.content},
                       {"reference", pixels_hash(plan.reference)},
                       {"methods", methods},
                       {"time", optional_json(plan.limits.seconds)},
                       {"passes", optional_json(plan.limits.passes)},
                       {"seeds", plan.seeds},
                       {"threads", plan.threads}};
    const Reference& r = plan.reference;
    identity.facts = {{"scene", a.scene.scene},
                      {"width", r.image.width},
                      {"height", r.image.height},
                      {"threads", plan.threads},
                      {"seeds", plan.seeds},
                      {"time", optional_json(plan.limits.seconds)},
                      {"passes", optional_json(plan.limits.passes)},
                      {"inherited", inherited_text(plan.scene)},
                      {"git_hash", git_hash()},
                      {"command", quoted(a.command_line)},
                      {"methods", methods_json(plan)},
                      {"reference",
                       {{"file", a.reference},
                        {"noise", optional_json(r.noise)},
                        {"bias_error", r.bias_error},
                        {"floor", r.floor()},
                        {"integrator", r.metadata("integrator")},
                        {"passes", r.metadata("passes")},
                        {"seconds", r.metadata("seconds")},
                        {"command", r.metadata("commandLine")}}}};
    return identity;
}

/// The beauty of the reference, so that the folder can be drawn again alone.
void keep_reference(const Folder& folder, const Reference& reference) {
    core::ImageChannels image;
    image.width = reference.image.width, image.height = reference.image.height;
    image.add_rgb("", reference.pixels);
    if (!reference.variance.empty()) image.add_rgb("Variance", reference.variance);
    for (const char* key : {"worldToCamera", "sceneContent", "noise", "leavesOut", "integrator", "seed",
                            "passes", "seconds", "software", "commandLine"})
        if (const std::string value = reference.metadata(key); !value.empty()) image.metadata[key] = value;
    core::write_exr(folder.file("reference.exr"), image);
}

void warn(const TradeArguments& a, const Plan& plan, const std::vector<std::string>& warnings) {
    std::vector<std::string> lines;
    for (const std::string& warning : warnings) lines.push_back("warning: " + warning);
    const core::Requirements requirements = core::find_requirements(plan.scene);
    for (const Method& m : plan.methods)
        for (const std::string& line : m.integrator->plan(plan.scene, requirements).warnings())
            lines.push_back(m.name + ": " + line);
    if (!plan.reference.noise)
        lines.emplace_back("warning: the reference is taken for exact: its own noise is not known");
    if (!a.quiet)
        for (const std::string& line : lines) note(line);
}

/// What a measurement writes under fixed names, or under those of its methods.
std::vector<NamedFile> outputs_of(const TradeArguments& a, const MethodsFile& file) {
    std::vector<NamedFile> outputs;
    const auto add = [&](const std::string& name) {
        outputs.push_back({"'" + core::printable(name) + "' of the trade",
                           (std::filesystem::path(a.output) / name).string()});
    };
    for (const char* name :
         {"trade.json", "trade.csv", "trade.svg", "trade.txt", "trade.html", "summary.json", "reference.exr"})
        add(name);
    for (const Method& m : file.methods) add(m.slug + ".exr");
    return outputs;
}

std::vector<NamedFile> inputs_of(const TradeArguments& a, const core::Scene& scene) {
    std::vector<NamedFile> inputs = scene_inputs(scene.parts().input_files);
    inputs.push_back({"the methods file", a.methods});
    inputs.push_back({"the reference", a.reference});
    return inputs;
}

int finish(const Folder& folder, int page_width, bool quiet) {
    draw(folder, page_width);
    if (!quiet) std::fputs((folder.read("trade.txt") + "\n").c_str(), stdout);
    for (const char* name : {"trade.csv", "trade.svg", "trade.txt", "summary.json", "trade.html"})
        std::fputs((folder.file(name) + "\n").c_str(), stdout);
    return exit_ok;
}

int redraw(const TradeArguments& a) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(a.output, ignored))
        throw core::InputError("there is no such folder", {a.output, 0});
    Folder folder(a.output);
    folder.open_existing();
    return finish(folder, a.page_width, a.quiet);
}

int measure(const TradeArguments& given) {
    const bool automatic = given.reference.empty();
    const TradeArguments a = with_defaults(given);
    std::optional<Interruption> interruption(std::in_place);
    interruption->end_at_once_while("loading the scene");
    const int threads = a.threads > 0 ? a.threads : tbb::info::default_concurrency();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    const core::Registry registry = make_registry();
    core::LoadReport loaded;
    const auto scene = load(a.scene, registry, &loaded);
    std::vector<std::string> warnings = scene->parts().warnings;
    warnings.insert(warnings.end(), loaded.approximations.begin(), loaded.approximations.end());
    const MethodsFile file = a.methods.empty()
                                 ? read_methods(default_methods(core::find_requirements(*scene)),
                                                "the default methods", registry, *scene, warnings)
                                 : read_methods_file(a.methods, registry, *scene, warnings);
    const Limits limits = limits_of(a, file);
    const std::string content = scene_content(*scene, a.scene.defines);
    if (automatic && !is_good_reference(a.reference, *scene, content, {core::infinity, false, false})) {
        interruption.reset();  // it has one of its own
        if (const int code = make_automatic_reference(a, file, limits); code != exit_ok) return code;
        interruption.emplace();
        interruption->end_at_once_while("loading the reference", "the same command continues");
    }
    // One of our own says how noisy it is, and the page with it; one that was chosen must do what was asked
    // for.
    const double resolve = automatic ? core::infinity : a.resolve;
    const Reference reference =
        load_reference(a.reference, *scene, content, {resolve, a.trust_reference, a.force_reference});
    if (const std::string doubt = denoised_doubt(reference.image.metadata, a.reference, ""); !doubt.empty())
        note("warning: " + doubt);
    std::vector<std::string> render_command = {"mote", "render", a.scene.scene};
    for (const std::string& define : a.scene.defines)
        render_command.insert(render_command.end(), {"-D", define});
    const Plan plan{*scene,
                    file.methods,
                    reference,
                    limits,
                    seeds_beside(reference.seed, a.seeds.value_or(file.seeds)),
                    content,
                    threads,
                    render_command,
                    a.checkpoint_every};
    check_outputs(outputs_of(a, file), inputs_of(a, *scene));
    Folder folder(a.output);
    folder.open(identity_of(a, plan), a.fresh);
    keep_reference(folder, reference);
    warn(a, plan, warnings);

    interruption->end_at_once_while(nullptr);
    ProgressLine progress(fmt::format("mote: trade on {}: {} methods, {} seeds, {} x {} pixels, {} threads",
                                      a.scene.scene, plan.methods.size(), plan.seeds.size(),
                                      scene->film().width, scene->film().height, threads),
                          a.quiet);
    const bool complete = [&] {
        try {
            return trade::run(plan, folder, *interruption, progress);
        } catch (...) {
            progress.end();
            throw;
        }
    }();
    progress.end();
    if (complete) {
        std::error_code ignored;
        std::filesystem::remove(folder.file("checkpoints"), ignored);  // unless something is in it
        return finish(folder, a.page_width, a.quiet);
    }
    note("interrupted: the same command continues");
    return 128 + interruption->signal_number();
}

}  // namespace

void add_trade(CLI::App& app, TradeArguments& a, std::function<int()>& action) {
    CLI::App& command =
        *app.add_subcommand("trade", "Measure error against time for several methods on a scene");
    command.add_option("SCENE", a.scene.scene, "The scene file");
    command
        .add_option("--reference", a.reference,
                    "The picture that is taken for right (default: one is rendered)")
        ->type_name("EXR");
    command
        .add_option("--methods", a.methods,
                    "Integrators and settings (see docs/guide.md; default: what suits the scene)")
        ->type_name("JSON");
    command.add_option("-o,--output", a.output, "The folder to write (default: SCENE_trade)")
        ->type_name("DIR");
    CLI::Option* make =
        command.add_option("--make-reference", a.make_reference, "Render a reference instead");
    make->type_name("EXR");
    command.add_option("--integrator", a.scene.integrator, "Of the reference (default: volpath, or path)")
        ->type_name("TYPE");
    command.add_option("--setting", a.settings, "A value of the reference's integrator (repeatable)")
        ->type_name("NAME=VALUE")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command.add_option("--resolve", a.resolve, "The smallest error that must be judged (default: 0.01)")
        ->check(number_above_0());
    command.add_option("--time", a.seconds, "Seconds for every method and seed, or for the reference")
        ->check(number_above_0());
    command.add_option("--passes", a.passes, "Passes for every method and seed, or for the reference")
        ->check(whole_number(1, std::uint64_t(1) << 30));
    command.add_option("--seeds", a.seeds, "Repetitions, each with a seed of its own")
        ->check(whole_number(1, 10000));
    command.add_option("-D,--define", a.scene.defines, "As for render (repeatable)")
        ->type_name("NAME=VALUE")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command.add_option("-t,--threads", a.threads, "Number of threads (default: one for every core)")
        ->check(whole_number(0, 4096));
    command
        .add_option("--page-width", a.page_width, "Largest width of the pictures in the page (default: 640)")
        ->check(whole_number(8, 8192));
    command.add_option("--checkpoint-every", a.checkpoint_every, "Seconds between checkpoints (default: 60)")
        ->check(number_from_0());
    command.add_flag("--fresh", a.fresh, "Start anew instead of continuing");
    command.add_flag("--trust-reference", a.trust_reference,
                     "Believe what the reference does not say of itself");
    command.add_flag("--force-reference", a.force_reference,
                     "Accept a reference of another version of the scene");
    CLI::Option* redraw_flag = command.add_flag("--redraw", a.redraw, "Draw the records in DIR again");
    redraw_flag->excludes(make);
    command.add_flag("--quiet", a.quiet, "No progress, no warnings");
    command.callback([&a, &action] { action = [&a] { return trade_command(a); }; });
}

int trade_command(const TradeArguments& arguments) {
    check_usage(arguments);
    if (arguments.redraw) return redraw(arguments);
    if (!arguments.make_reference.empty()) return make_reference(arguments);
    return measure(arguments);
}

}  // namespace mote::apps
