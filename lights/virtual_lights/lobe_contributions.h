// Unoccluded light of one virtual point light at sixteen receivers where f* of both ends is constant or
// Henyey-Greenstein's function: the loop of vpl_contributions.h with two lobes, without a branch.
#pragma once

#include "lights/virtual_lights/vpl_contributions.h"

namespace mote::lights {

/// The lobes of sixteen receivers.
struct alignas(64) ReceiverLobes {
    static constexpr int width = ReceiverLanes::width;
    float g[width] = {};                                ///< |g|; 0: f* is constant and in the weight
    float x[width] = {}, y[width] = {}, z[width] = {};  ///< the preferred direction of wi
    bool known = true;                                  ///< false: some f* is neither

    ReceiverLobes() = default;
    explicit ReceiverLobes(const ReceiverLanes& receivers);
};

/// contributions_of() with min(G*, b), by the quicker loop where that is right.
bool lobe_contributions(const VplSet& vpls, const WeightedVpl& light, const ReceiverLanes& receivers,
                        const ReceiverLobes& lobes, const BoundedGeometry& weight, core::ShadowPacket& packet,
                        LaneLight& out);

}  // namespace mote::lights
