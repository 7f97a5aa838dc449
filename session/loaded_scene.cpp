#include "session/loaded_scene.h"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

#include "core/files/checksum.h"
#include "core/formats/xml/scene_making.h"
#include "core/objects/memory_error.h"
#include "core/render/render_driver.h"
#include "session/borrowed_arena.h"
#include "session/placement_notes.h"
#include "session/plugins.h"
#include "session/reference_metadata.h"
#include "session/registry.h"

namespace mote::session {

core::LoadOptions load_options(const SceneChanges& changes) {
    core::LoadOptions options;
    options.integrator = changes.integrator, options.default_integrator = "mote_layers";
    options.lenient = changes.lenient, options.frame = changes.frame;
    options.defines = changes.defines;
    return options;
}

SceneChanges at_size(SceneChanges changes, int width, int height) {
    changes.defines.emplace_back("film.width", std::to_string(width));
    changes.defines.emplace_back("film.height", std::to_string(height));
    return changes;
}

std::vector<std::string> define_texts(const SceneChanges& changes) {
    std::vector<std::string> texts;
    for (const auto& [name, value] : changes.defines) texts.push_back(name + "=" + value);
    return texts;
}

std::vector<std::string> command_options(const SceneChanges& changes) {
    std::vector<std::string> options;
    if (!changes.integrator.empty()) options.insert(options.end(), {"--integrator", changes.integrator});
    for (const std::string& define : define_texts(changes)) options.insert(options.end(), {"-D", define});
    if (changes.lenient) options.emplace_back("--lenient");
    for (const std::string& plugin : changes.plugins) options.insert(options.end(), {"--plugin", plugin});
    return options;
}

std::vector<std::string> render_settings(const SceneChanges& changes, const std::string& integrator) {
    std::vector<std::string> settings = {MOTE_VERSION, integrator, changes.integrator};
    for (const std::string& define : define_texts(changes)) settings.push_back(define);
    if (changes.lenient) settings.emplace_back("--lenient");
    for (std::string& plugin : plugin_settings(changes.plugins)) settings.push_back(std::move(plugin));
    return settings;
}

std::vector<std::string> frame_before_settings(const SceneChanges& changes) {
    std::vector<std::string> settings = define_texts(changes);
    settings.insert(settings.begin(), "the frame before");
    return settings;
}

template <typename Load>
void LoadedScene::load(const SceneChanges& changes, const Load& load_now) {
    const auto begin = std::chrono::steady_clock::now();
    changes_ = changes;
    core::LoadOptions options = load_options(changes);
    options.report = &report_;
    BorrowedArena arena(0);
    arena.execute(
        [&] { scene_ = core::with_memory_for("loading the scene", [&] { return load_now(options); }); });
    load_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

LoadedScene LoadedScene::from_file(const std::string& path, const SceneChanges& changes) {
    return from_file(path, changes, std::make_shared<const core::Registry>(make_registry(changes.plugins)),
                     core::MemoryBudget());
}

LoadedScene LoadedScene::from_file(const std::string& path, const SceneChanges& changes,
                                   std::shared_ptr<const core::Registry> registry) {
    return from_file(path, changes, std::move(registry), std::nullopt);
}

LoadedScene LoadedScene::from_file(const std::string& path, const SceneChanges& changes,
                                   std::shared_ptr<const core::Registry> registry,
                                   const std::optional<core::MemoryBudget>& memory) {
    LoadedScene loaded;
    loaded.registry_ = registry;
    loaded.load(changes, [&](core::LoadOptions options) {
        options.memory = memory;
        return core::load_scene(path, *loaded.registry_, options);
    });
    loaded.reload_ = [path, registry](const SceneChanges& others) {
        return from_file(path, others, registry);
    };
    return loaded;
}

LoadedScene LoadedScene::from_text(const std::string& xml, const std::string& folder,
                                   const SceneChanges& changes, const std::string& name) {
    return from_text(xml, folder, changes, name,
                     std::make_shared<const core::Registry>(make_registry(changes.plugins)));
}

LoadedScene LoadedScene::from_text(const std::string& xml, const std::string& folder,
                                   const SceneChanges& changes, const std::string& name,
                                   std::shared_ptr<const core::Registry> registry) {
    LoadedScene loaded;
    loaded.registry_ = registry;
    loaded.source_ = fmt::format("{:016x}", core::checksum(std::as_bytes(std::span(xml))));
    loaded.load(changes, [&](const core::LoadOptions& options) {
        return core::load_scene_from_string(xml, folder, *loaded.registry_, options, name);
    });
    loaded.reload_ = [xml, folder, name, registry](const SceneChanges& others) {
        return from_text(xml, folder, others, name, registry);
    };
    return loaded;
}

LoadedScene LoadedScene::from_tree(const SceneTree& tree, const SceneChanges& changes) {
    core::Registry registry = make_registry(changes.plugins);
    register_arrays(registry, tree.array_store());
    return from_tree(std::make_shared<const SceneTree>(tree), changes,
                     std::make_shared<const core::Registry>(std::move(registry)));
}

LoadedScene LoadedScene::from_tree(std::shared_ptr<const SceneTree> tree, const SceneChanges& changes,
                                   std::shared_ptr<const core::Registry> registry) {
    LoadedScene loaded;
    loaded.registry_ = registry;
    loaded.source_ = tree->checksum();
    loaded.load(changes, [&](const core::LoadOptions& options) {
        core::SceneDefines defines(options.defines);
        return core::make_scene(tree->document(), defines, *loaded.registry_, options, tree->name());
    });
    loaded.reload_ = [tree, registry](const SceneChanges& others) {
        return from_tree(tree, others, registry);
    };
    return loaded;
}

const core::Integrator& LoadedScene::integrator() const {
    return integrator_ ? *integrator_ : require_integrator(*scene_, *registry_);
}

LoadedScene LoadedScene::rendered_by(std::shared_ptr<const core::Integrator> integrator,
                                     const std::vector<std::string>& settings) const {
    LoadedScene copy = *this;
    copy.integrator_ = std::move(integrator), copy.integrator_settings_ = settings;
    return copy;
}

std::shared_ptr<const core::PreviousFrame> LoadedScene::frame_of(LoadedScene&& scene) {
    if (scene.scene_.use_count() != 1)
        throw std::logic_error("a scene that is still used is no frame before");
    return std::make_shared<const core::PreviousFrame>(std::move(scene.scene_));
}

core::Plan LoadedScene::plan() const {
    constexpr double worth_a_line = 1e8;  // [B]
    core::Plan plan = integrator().plan(*scene_, core::find_requirements(*scene_));
    if (core::sum_of(report_.files) >= worth_a_line)
        plan.run("memory of files", "at least " + core::memory_summary(report_.files),
                 "by their headers, before they are read");
    return plan;
}

std::vector<std::string> LoadedScene::warnings() const { return scene_warnings(*scene_, report_); }

std::string LoadedScene::scene_hash(const std::vector<std::string>& more) const {
    std::vector<std::string> settings = render_settings(changes_, integrator().type());
    if (!source_.empty()) settings.push_back(source_);
    for (const auto& list : {integrator_settings_, more})
        settings.insert(settings.end(), list.begin(), list.end());
    return core::content_hash(*scene_, settings);
}

std::string LoadedScene::scene_content() const {
    std::vector<std::string> defines = define_texts(changes_);
    if (!source_.empty()) defines.push_back(source_);
    return session::scene_content(*scene_, defines);
}

const core::Integrator& require_integrator(const core::Scene& scene, const core::Registry& registry) {
    if (scene.integrator()) return *scene.integrator();
    std::string known;
    for (const std::string& type : registry.types(core::Category::integrator))
        known += (known.empty() ? "" : ", ") + type;
    throw core::InputError("the scene names no integrator: choose one with --integrator (" + known + ")",
                           {scene.parts().file, 0});
}

std::vector<std::string> scene_warnings(const core::Scene& scene, const core::LoadReport& report) {
    std::vector<std::string> lines;
    for (const std::string& text : report.approximations) lines.push_back("--lenient: " + text);
    for (const std::string& text : scene.parts().warnings) lines.push_back("warning: " + text);
    for (const std::string& text : placement_notes(scene)) lines.push_back("warning: " + text);
    return lines;
}

}  // namespace mote::session
