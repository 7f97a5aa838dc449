// From settings to records: everything is read and checked before the first pass.
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "core/files/checksum.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/scene_element.h"
#include "core/objects/error.h"
#include "session/denoise/denoised_layer.h"
#include "session/output_files.h"
#include "session/plugins.h"
#include "session/reference_metadata.h"
#include "session/render_report.h"
#include "trade/draw.h"
#include "trade/methods_file.h"
#include "trade/run.h"
#include "trade/trade.h"

namespace mote::trade {

using namespace session;

namespace {

using nlohmann::json;

constexpr const char* automatic_reference = "automatic_reference.exr";
constexpr double seconds_of_automatic_reference = 120.0;  ///< where passes are the limit

/// The one that was given, or one of the folder's own.
std::string reference_file(const Settings& s) {
    return s.reference.empty() ? (std::filesystem::path(folder_of(s)) / automatic_reference).string()
                               : s.reference;
}

Limits limits_of(const Settings& s, const MethodsFile& file) {
    if (s.seconds || s.passes) return {s.seconds, s.passes};
    if (!file.seconds && !file.passes)
        throw core::InputError(
            "it says neither 'time' nor 'passes', nor does the command line (--time, --passes)",
            {s.methods, 0});
    return {file.seconds, file.passes};
}

/// Renders a reference where none was given, for as long as all methods together take at most, or continues
/// it. Returns false when interrupted.
bool make_automatic_reference(const Settings& s, const MethodsFile& file, const Limits& limits, Host& host) {
    Settings reference = s;
    reference.passes.reset();
    const double renders = double(file.methods.size()) * s.seeds.value_or(file.seeds);
    reference.seconds = limits.seconds ? renders * *limits.seconds : seconds_of_automatic_reference;
    return make_reference(reference, {reference_file(s), false, "", {}}, host);
}

std::string pixels_hash(const Reference& reference) {
    const auto bytes = std::as_bytes(std::span(reference.pixels));
    return fmt::format("{:016x}", core::checksum(bytes));
}

/// Settings of the scene's integrators, for the page.
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

Identity identity_of(const Settings& a, const Plan& plan) {
    Identity identity;
    json methods = json::array();
    for (const Method& m : plan.methods) methods.push_back({m.name, m.type, m.settings});
    identity.inputs = {{"mote", MOTE_VERSION},
                       {"error", "relative_error.h"},  // records of another measure are not to be continued
                       {"scene", plan.content},
                       {"plugins", plugin_settings(a.changes.plugins)},
                       {"reference", pixels_hash(plan.reference)},
                       {"methods", methods},
                       {"time", optional_json(plan.limits.seconds)},
                       {"passes", optional_json(plan.limits.passes)},
                       {"seeds", plan.seeds},
                       {"threads", plan.threads}};
    const Reference& r = plan.reference;
    identity.facts = {{"scene", a.scene},
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
                       {{"file", reference_file(a)},
                        {"noise", optional_json(r.noise)},
                        {"bias_error", r.bias_error},
                        {"floor", r.floor()},
                        {"integrator", r.metadata("integrator")},
                        {"passes", r.metadata("passes")},
                        {"seconds", r.metadata("seconds")},
                        {"command", r.metadata("commandLine")}}}};
    return identity;
}

/// The beauty of the reference, so that the folder can be plotted again alone.
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

void warn(const Plan& plan, const std::vector<std::string>& warnings, Host& host) {
    for (const std::string& warning : warnings) host.remark("warning: " + warning);
    const core::Requirements requirements = core::find_requirements(plan.scene);
    for (const Method& m : plan.methods)
        for (const std::string& line : m.integrator->plan(plan.scene, requirements).warnings())
            host.remark(m.name + ": " + line);
    if (!plan.reference.noise)
        host.remark("warning: the reference is taken for exact: its own noise is not known");
}

void check_inputs(const Settings& s, const MethodsFile& file, const core::Scene& scene) {
    std::vector<NamedFile> outputs, inputs = scene_inputs(scene.parts().input_files);
    for (const std::string& name : Folder::file_names(file.methods))
        outputs.push_back({"'" + core::printable(name) + "' of the trade",
                           (std::filesystem::path(folder_of(s)) / name).string()});
    inputs.push_back({"the methods file", s.methods});
    inputs.push_back({"the reference", reference_file(s)});
    check_outputs(outputs, inputs);
}

std::vector<std::string> render_command_of(const Settings& s) {
    std::vector<std::string> command = {"mote", "render", s.scene};
    for (std::string& option : command_options(s.changes)) command.push_back(std::move(option));
    return command;
}

bool run_with_progress(const Plan& plan, Folder& folder, Host& host) {
    host.begin(fmt::format("mote: trade on {}: {} methods, {} seeds, {} x {} pixels, {} threads",
                           plan.scene.parts().file, plan.methods.size(), plan.seeds.size(),
                           plan.scene.film().width, plan.scene.film().height, plan.threads));
    try {
        const bool complete = run(plan, folder, host);
        host.end();
        return complete;
    } catch (...) {
        host.end();
        throw;
    }
}

}  // namespace

std::string folder_of(const Settings& s) {
    return s.output.empty() ? std::filesystem::path(s.scene).stem().string() + "_trade" : s.output;
}

bool measure(const Settings& s, Host& host) {
    host.idle_while("loading the scene");
    const LoadedScene loaded = LoadedScene::from_file(s.scene, s.changes);
    const core::Scene& scene = loaded.scene();
    std::vector<std::string> warnings = scene.parts().warnings;
    const auto& approximations = loaded.report().approximations;
    warnings.insert(warnings.end(), approximations.begin(), approximations.end());
    const MethodsFile file = s.methods.empty()
                                 ? read_methods(default_methods(core::find_requirements(scene)),
                                                "the default methods", loaded.registry(), scene, warnings)
                                 : read_methods_file(s.methods, loaded.registry(), scene, warnings);
    const Limits limits = limits_of(s, file);
    const std::string content = loaded.scene_content();
    check_inputs(s, file, scene);
    const bool automatic = s.reference.empty();
    std::optional<Folder> folder;  // none is left of a trade that is refused
    if (automatic) folder.emplace(folder_of(s), file.methods, s.fresh);
    if (automatic && !is_good_reference(reference_file(s), scene, content, {core::infinity, false, false})) {
        if (!make_automatic_reference(s, file, limits, host)) return false;
        host.idle_while("loading the reference", "the same command continues");
    }
    // A reference of our own may be noisy, and the page says so; one that was given must resolve the
    // requested error.
    const Reference reference =
        load_reference(reference_file(s), scene, content,
                       {automatic ? core::infinity : s.resolve, s.trust_reference, s.force_reference});
    if (const std::string doubt = denoised_doubt(reference.image.metadata, reference_file(s), "");
        !doubt.empty())
        host.note("warning: " + doubt);
    const Plan plan{scene,
                    file.methods,
                    reference,
                    limits,
                    seeds_beside(reference.seed, s.seeds.value_or(file.seeds)),
                    content,
                    s.threads,
                    render_command_of(s),
                    s.checkpoint_every};
    if (!folder) folder.emplace(folder_of(s), file.methods, s.fresh);
    folder->open(identity_of(s, plan));
    keep_reference(*folder, reference);
    warn(plan, warnings, host);
    host.idle_while(nullptr);
    if (!run_with_progress(plan, *folder, host)) {
        host.note("interrupted: the same command continues");
        return false;
    }
    folder->remove_checkpoints();
    draw(*folder, s.page_width);
    return true;
}

void redraw(const std::string& path, int page_width) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(path, ignored))
        throw core::InputError("there is no such folder", {path, 0});
    draw(Folder::existing(path), page_width);
}

}  // namespace mote::trade
