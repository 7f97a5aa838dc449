// A scene with the parts that it was made of: from a file, from text, or built in memory.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/formats/xml/scene_loader.h"
#include "core/render/integrator.h"
#include "core/render/motion_features.h"
#include "core/scene/scene.h"
#include "session/scene_tree.h"

namespace mote::session {

/// Changes to a scene when it is loaded, as on the command line.
struct SceneChanges {
    std::string integrator;  ///< this type instead of the scene's; "": its own
    std::vector<std::pair<std::string, std::string>> defines;  ///< -D name=value
    bool lenient = false;                                      ///< leave out or approximate what is wrong
    std::optional<int> frame = {};                             ///< of a sequence: the number in file names
    std::vector<std::string> plugins = {};  ///< files, besides those of MOTE_PLUGINS (session/plugins.h)
};

/// The options of the loader for them. A scene without an integrator gets `mote_layers`.
core::LoadOptions load_options(const SceneChanges& changes);
/// `changes` with a film of another size.
SceneChanges at_size(SceneChanges changes, int width, int height);
/// "name=value" of each definition.
std::vector<std::string> define_texts(const SceneChanges& changes);
/// The options of `mote render` that make these changes.
std::vector<std::string> command_options(const SceneChanges& changes);
/// Settings that determine the bits of a picture besides the contents of the scene's files: for
/// core::content_hash().
std::vector<std::string> render_settings(const SceneChanges& changes, const std::string& integrator);

/// Those of the frame before in a sequence, where a picture holds motion vectors.
std::vector<std::string> frame_before_settings(const SceneChanges& changes);

/// A scene that may be rendered, by several threads at once. Copies share it.
class LoadedScene {
  public:
    /// All throw InputError, or SceneErrors with all that is wrong. A path may name XML, glTF, GLB or pbrt.
    static LoadedScene from_file(const std::string& path, const SceneChanges& changes = {});
    /// By a registry that several scenes share, for it keeps meshes that they have in common: what is still
    /// to be loaded is then not known, and not compared with the memory that is left.
    static LoadedScene from_file(const std::string& path, const SceneChanges& changes,
                                 std::shared_ptr<const core::Registry> registry);
    /// Relative file names are looked up in `folder`; `name` replaces that of a file in messages.
    static LoadedScene from_text(const std::string& xml, const std::string& folder,
                                 const SceneChanges& changes = {}, const std::string& name = "<string>");
    /// From elements that were built in memory.
    static LoadedScene from_tree(const SceneTree& tree, const SceneChanges& changes = {});

    const core::Scene& scene() const { return *scene_; }           ///< lives as long as this, or a copy of it
    const core::Registry& registry() const { return *registry_; }  ///< the types that it was loaded with
    const core::LoadReport& report() const { return report_; }     ///< approximations
    const SceneChanges& changes() const { return changes_; }       ///< with which it was loaded
    /// Text of the scene, in today's words, with every change applied.
    const core::Element& elements() const { return *report_.elements; }
    /// Loads the same file, text or elements with other changes; meshes that stay are not read again.
    LoadedScene reloaded(const SceneChanges& changes) const { return reload_(changes); }
    /// Throws InputError where the scene names none.
    const core::Integrator& integrator() const;
    /// A copy that another integrator renders; `settings` are what determines its pictures besides its type.
    LoadedScene rendered_by(std::shared_ptr<const core::Integrator> integrator,
                            const std::vector<std::string>& settings) const;
    /// Camera and shapes of a scene that has no other copy, for motion vectors of the next frame.
    static std::shared_ptr<const core::PreviousFrame> frame_of(LoadedScene&& scene);
    /// Parts that will run, with the reason for every choice.
    core::Plan plan() const;
    /// Left-out and approximated elements, and everything else worth a warning.
    std::vector<std::string> warnings() const;
    double load_seconds() const { return load_seconds_; }  ///< wall time
    /// core::content_hash() of everything that determines the bits of the picture, `more` included, and of
    /// the scene alone.
    std::string scene_hash(const std::vector<std::string>& more = {}) const;
    std::string scene_content() const;

  private:
    LoadedScene() = default;
    static LoadedScene from_file(const std::string& path, const SceneChanges& changes,
                                 std::shared_ptr<const core::Registry> registry,
                                 const std::optional<core::MemoryBudget>& memory);
    static LoadedScene from_text(const std::string& xml, const std::string& folder,
                                 const SceneChanges& changes, const std::string& name,
                                 std::shared_ptr<const core::Registry> registry);
    static LoadedScene from_tree(std::shared_ptr<const SceneTree> tree, const SceneChanges& changes,
                                 std::shared_ptr<const core::Registry> registry);
    template <typename Load>
    void load(const SceneChanges& changes, const Load& load_now);

    std::shared_ptr<const core::Registry> registry_;
    std::shared_ptr<core::Scene> scene_;
    std::shared_ptr<const core::Integrator> integrator_;  ///< instead of the scene's
    std::vector<std::string> integrator_settings_;
    core::LoadReport report_;
    SceneChanges changes_;
    std::string source_;  ///< hash of what was loaded where there is no file
    double load_seconds_ = 0.0;
    std::function<LoadedScene(const SceneChanges&)> reload_;
};

/// The integrator of a scene. Throws InputError that lists those there are when the scene names none.
const core::Integrator& require_integrator(const core::Scene& scene, const core::Registry& registry);
/// All that is worth a warning about a scene: each begins with "--lenient: " or "warning: ".
std::vector<std::string> scene_warnings(const core::Scene& scene, const core::LoadReport& report);

}  // namespace mote::session
