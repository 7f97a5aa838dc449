// Selectors that sample a few VPLs for all receivers of a tile; the one gather (vpl_gather.h) sums their
// light.
#pragma once

#include "lights/selection/selection.h"

namespace mote::lights {

class SamplingSelector : public TileSelector {
  public:
    /// The VPLs must outlive it; `bound` as in SelectionPass.
    SamplingSelector(const VplSet& vpls, float bound) : vpls_(vpls), bound_{bound} {}
    TileLight gather(const GatherContext& context, ReceiverTile& receivers, const VplRange& range,
                     BatchVisibility& visibility, core::Rng& rng) final;

  protected:
    /// VPLs with weights 1 / (n p), valid until the next call; none: no light. Lanes whose `max_vpl_depth` is
    /// 0 are idle, what else they hold has no meaning; all lanes get the light of the same VPLs. p may be 0
    /// for a VPL that is deeper (VirtualPointLight::depth) than max_vpl_depth of every lane, and for no other
    /// whose light reaches one. Called once for a tile, on surfaces and in media.
    virtual std::span<const WeightedVpl> sample(const ReceiverLanes& receivers, core::Rng& rng) = 0;
    /// If true, record_light() needs the light of every sample.
    virtual bool learns() const { return false; }
    /// Light of the i-th sample at all receivers, average of the channels, in order; 0 where none arrives.
    virtual void record_light(std::size_t, double) {}

  private:
    const VplSet& vpls_;
    BoundedGeometry bound_;
};

}  // namespace mote::lights
