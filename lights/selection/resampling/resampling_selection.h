// Resampled importance sampling (Talbot et al. 2005) as a selection: candidates from a cut, a few VPLs for
// each pixel.
#pragma once

#include <cstdint>

#include "lights/selection/selection.h"

namespace mote::core {
class Registry;
}

namespace mote::lights {

class ResamplingSelection final : public Selection {
  public:
    /// `candidates` of a tile, of which each pixel takes `samples`.
    ResamplingSelection(std::uint32_t candidates, std::uint32_t samples)
        : candidates_(candidates), samples_(samples) {}
    std::unique_ptr<VplSelector> prepare(const SelectionPass& pass) const override;
    std::string excludes(const GatherOptions& options) const override;
    std::size_t memory_bytes(std::size_t vpls) const override;
    void plan(core::Plan& plan, const SelectionSize& size) const override;

  private:
    std::uint32_t candidates_, samples_;
};

void register_resampling_selection(core::Registry& registry);

}  // namespace mote::lights
