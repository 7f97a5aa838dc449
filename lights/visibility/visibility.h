// Visibility between VPLs and receivers: what lies between them, by shadow rays or by maps.
//
// A scene file names a Visibility by a nested <visibility>. It is prepared once for a scene, and once a pass
// for its VPLs; tasks then gather at one tile of sixteen receivers after the other. Calls are virtual per
// tile, never per pair. A kind of visibility is a file that
// register_visibility() names.
#pragma once

#include <memory>
#include <optional>

#include "core/film/pass_image.h"
#include "core/objects/memory_budget.h"
#include "core/objects/registry.h"
#include "core/render/plan.h"
#include "core/render/statistics.h"
#include "core/scene/lit_scene.h"
#include "lights/selection/selection.h"
#include "lights/shadow_maps/light_shadow_maps.h"

namespace mote::lights {

/// A gather at sixteen receivers.
struct TileGather {
    TileSelector& selector;
    const GatherContext& context;
    ReceiverTile& receivers;
    const VplRange& range;
    core::Rng& rng;     ///< of the selector
    int column, row;    ///< pixel of the first lane; lanes continue in rows of four
    int spacing;        ///< pixels from lane to lane
    float light_scale;  ///< of what is added to the image later
};

/// A pass, as visibility sees it.
struct VisibilityPass {
    const VplSet& vpls;  ///< outlive the pass
    float bound;         ///< b of the geometry term [1/m^2], infinity for none
    std::uint64_t key;   ///< determines random numbers
    std::size_t tasks;   ///< of the pass
    const std::atomic<bool>& cancelled;
    core::PassImage& image;
};

/// Visibility in one scene.
class PreparedVisibility {
  public:
    virtual ~PreparedVisibility() = default;
    /// Before the tasks of a pass.
    virtual void begin(const VisibilityPass&) {}
    /// Light of the VPLs that the selector chooses; none where finish() adds it. Safe from many threads, of
    /// which each has tasks of its own.
    virtual TileLight gather(std::size_t task, const TileGather& gather) = 0;
    /// After all tasks: adds light to the image that waited for all receivers. Returns false when cancelled.
    virtual bool finish(const VisibilityPass&) { return true; }
    /// Maps of the primary lights; null where these are traced.
    virtual const LightShadowMaps* of_lights() const { return nullptr; }
    virtual void add_statistics(core::Statistics&) const {}
};

/// Maps of the primary lights.
struct LightMapSettings {
    int size = 256;  ///< texels along an edge; 0: lights are traced
    ShadowMapSettings map;
    core::SourceLocation where;  ///< in the scene file, of the size
};

/// A nested <visibility> of a scene file.
class Visibility : public core::Object {
  public:
    /// Throws InputError where a map of this scene would be larger than its limit, OutOfMemory.
    virtual std::unique_ptr<PreparedVisibility> prepare(const core::LitScene& scene, std::uint64_t seed,
                                                        const core::MemoryBudget& memory) const = 0;
    /// Maps of lights, for methods that have no VPLs; nothing: lights are traced.
    virtual std::optional<LightMapSettings> light_maps() const { return std::nullopt; }
    /// True where what lies between a VPL and a receiver is found without an error in the mean.
    virtual bool is_exact() const { return false; }
    /// Says so where shadow maps are used, for options that do not go with them.
    virtual void declare(GatherOptions&) const {}
    /// `receivers`: of one pass, about.
    virtual void plan(core::Plan& plan, const core::LitScene& scene, double receivers) const = 0;
};

/// Shadow rays, and tracking through media: exact.
std::shared_ptr<Visibility> traced_visibility();
/// Visibility without maps, prepared.
std::unique_ptr<PreparedVisibility> prepare_traced_visibility();

/// traced, shadow_map, imperfect_shadow_map.
void register_visibility(core::Registry& registry);
void register_imperfect_visibility(core::Registry& registry);
void register_shadow_map_visibility(core::Registry& registry);

}  // namespace mote::lights
