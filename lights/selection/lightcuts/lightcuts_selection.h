// Lightcuts (Walter et al. 2005) and multidimensional lightcuts (Walter et al. 2006) as selections.
#pragma once

#include "lights/selection/lightcuts/lightcut.h"
#include "lights/selection/selection.h"

namespace mote::core {
class Registry;
}

namespace mote::lights {

class LightcutsSelection final : public Selection {
  public:
    /// `multidimensional`: one cut for all points of a pixel, else one for each.
    LightcutsSelection(const LightcutSettings& settings, bool multidimensional)
        : settings_(settings), multidimensional_(multidimensional) {}
    std::unique_ptr<VplSelector> prepare(const SelectionPass& pass) const override;
    std::string excludes(const GatherOptions& options) const override;
    std::size_t memory_bytes(std::size_t vpls) const override;
    void plan(core::Plan& plan, const SelectionSize& size) const override;

  private:
    LightcutSettings settings_;
    bool multidimensional_;
};

void register_lightcuts(core::Registry& registry);

}  // namespace mote::lights
