// The target function of resampling: the unoccluded light of a virtual point light at a receiver.
//
// Luminance of f*(x) min(G*(x,y_j), b) I_j, times the throughput of the eye path, times a guess of the
// transmittance, where t is the distance times the mean of the extinctions at both ends: 1 / (1 + t + t^2/2 +
// t^3/6) in a homogeneous medium, which is nearly e^-t, and 1 / (1 + t) in others. It falls slowly because t
// may be wrong: light that is guessed too dark is chosen less often, and counts the more when it is. The
// function is 0 only where no light arrives.
//
// Phase functions are evaluated for sixteen lanes at once (virtual_lights/lobe_contributions.h), glossy
// surfaces lane by lane.
#pragma once

#include "core/math/lanes.h"
#include "lights/virtual_lights/lobe_contributions.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// The target function at sixteen receivers.
class ResamplingTarget {
  public:
    static constexpr int width = ReceiverLanes::width;

    /// Keeps references to both. `bound`: b [1/m^2], infinity for none. `attenuates`: the scene has media.
    ResamplingTarget(const VplSet& vpls, const ReceiverTile& tile, float bound, bool attenuates);

    /// Target times the weight of the VPL, by lane, where `extinction` is that at the VPL (0 without
    /// medium()). Returns false, and nothing counts, where it is 0 at every lane.
    bool of_light(const WeightedVpl& light, float extinction, GatherScratch& scratch, core::Lanes& out) const;
    const core::Medium* medium() const { return medium_; }  ///< medium with the extinction at VPLs, or null
    float extinction_at(const core::Vec3& light) const;
    /// One lane's unoccluded light, with its shadow ray; the value is its luminance.
    struct Connection {
        core::Rgb light{0.0f};
        core::Vec3 origin{0.0f}, target{0.0f};
        float value = 0.0f;
    };
    Connection of_lane(int lane, std::size_t light) const;

  private:
    const VplSet* vpls_;
    const ReceiverTile* tile_;
    BoundedGeometry bound_;
    const core::Medium* medium_ = nullptr;  ///< of the first lane in one
    ReceiverLobes lobes_;                   ///< of the tile
    float fast_ = 0.0f;                     ///< 1: the guess of the transmittance falls like e^-t
    core::Lanes own_half_;  ///< half of the extinction at a receiver; where `medium_` is not its medium, all
    core::Lanes other_half_;  ///< 1/2 where that at the VPL counts, else 0
};

}  // namespace mote::lights
