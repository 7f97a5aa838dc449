// Stochastic lightcuts (Yuksel 2019) and sampling by a light tree (Estevez and Kulla 2018) as selections.
#pragma once

#include <cstdint>

#include "lights/selection/selection.h"

namespace mote::core {
class Registry;
}

namespace mote::lights {

class StochasticSelection final : public Selection {
  public:
    /// `samples` VPLs a tile, from the clusters of a cut, or each from the root of the tree.
    StochasticSelection(std::uint32_t samples, bool by_cut) : samples_(samples), by_cut_(by_cut) {}
    std::unique_ptr<VplSelector> prepare(const SelectionPass& pass) const override;
    std::size_t memory_bytes(std::size_t vpls) const override;
    void plan(core::Plan& plan, const SelectionSize& size) const override;

  private:
    std::uint32_t samples_;
    bool by_cut_;
};

void register_stochastic_selection(core::Registry& registry);

}  // namespace mote::lights
