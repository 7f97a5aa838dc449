// Which virtual point lights `mote_vpl` looks at: a nested <selection> of a scene file.
#pragma once

#include "core/objects/error.h"
#include "core/objects/registry.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"
#include "lights/selection/lightcut.h"

namespace mote::integrators {

struct SelectionSettings {
    enum class Kind : std::uint8_t { all, lightcuts, multidimensional, stochastic, light_tree };

    Kind kind = Kind::all;
    lights::LightcutSettings cut;
    std::uint32_t samples = 64;                    ///< drawn for a tile of receivers
    std::size_t max_bytes = std::size_t(4) << 30;  ///< of the hierarchy while it is built
    core::SourceLocation where;

    bool by_hierarchy() const { return kind != Kind::all; }
    /// A sum of groups, which looks at what arrives; else lights are drawn without bias.
    bool cuts() const { return kind == Kind::lightcuts || kind == Kind::multidimensional; }
    /// All points of a pixel are gathered at once.
    bool collects() const { return kind == Kind::multidimensional; }
};

class Selection : public core::Object {
  public:
    explicit Selection(const SelectionSettings& settings) : settings_(settings) {}
    const SelectionSettings& settings() const { return settings_; }

  private:
    SelectionSettings settings_;
};

/// all, lightcuts, multidimensional_lightcuts, stochastic_lightcuts, light_tree.
void register_selection(core::Registry& registry);

/// What a pass is about to gather, for the plan.
struct GatherSize {
    double vpls = 0.0;       ///< about
    double receivers = 0.0;  ///< of a picture, about
    int points = 1;          ///< a pixel, on surfaces and in media
};

/// What runs, and what would be better here and why: brute force costs lights times receivers, a hierarchy
/// some hundred lights a receiver.
void plan_selection(core::Plan& plan, const SelectionSettings& settings, const GatherSize& size);

}  // namespace mote::integrators
