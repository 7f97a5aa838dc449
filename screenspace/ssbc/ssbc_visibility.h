// Shadow rays for screen-space bias compensation, to measure what leaving visibility out costs. The more
// layers a picture has, the more of its patches lie behind something.
#pragma once

#include "screenspace/ssbc/ssbc_sum.h"

namespace mote::core {
class RayQueries;
}

namespace mote::screenspace {

class TracedVisibility final : public ResidualVisibility {
  public:
    /// Keeps a reference to the scene.
    explicit TracedVisibility(const core::RayQueries& scene) : scene_(scene) {}
    /// Both ends of a ray stand off their patches by a twentieth of the patch, and by what a node is thick.
    void shadow(const ReceiverPacket& receivers, const SurfaceNode& node, Lanes& residual) const override;

  private:
    const core::RayQueries& scene_;
};

}  // namespace mote::screenspace
