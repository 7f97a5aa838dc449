// The target function of resampling: what a virtual point light is thought to send to a receiver.
//
// Luminance of f*(x) min(G*(x,y_j), b) I_j, times the throughput of the eye path, as if no surface stood
// between, and times a guess of the transmittance: 1 / (1 + t + t^2/2 + t^3/6), where t is the distance times
// the mean of the extinctions at both ends. It is e^-t nearly where t is small, and where t is large it falls
// more slowly, since the guess may be wrong: what it takes for dark is chosen less often, and never counts
// much when it is. The function is the same whenever it is asked, and 0 only where no light arrives.
#pragma once

#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// Sixteen receivers, as the target function sees them.
class ResamplingTarget {
  public:
    static constexpr int width = ReceiverLanes::width;
    using Lanes = std::array<float, width>;

    /// Keeps references to all. `bound`: b [1/m^2], infinity for none. `attenuates`: whether there are media.
    ResamplingTarget(const VplSet& vpls, const ReceiverTile& tile, float bound, bool attenuates);

    /// The target times the weight of the light. Returns false, and nothing counts, where it is 0 everywhere.
    bool of_light(const WeightedVpl& light, GatherScratch& scratch, Lanes& out) const;
    /// The same of one lane, with the light that arrives and its shadow ray.
    struct Connection {
        core::Rgb light{0.0f};
        core::Vec3 origin{0.0f}, target{0.0f};
        float value = 0.0f;
    };
    Connection of_lane(int lane, std::size_t light) const;

    /// 1 over the luminance of what a lane does to all light: it makes targets of different receivers alike.
    float scale(int lane) const { return scale_[std::size_t(lane)]; }
    const ReceiverTile& tile() const { return *tile_; }

  private:
    float extinction_at(const core::Vec3& light) const;

    const VplSet* vpls_;
    const ReceiverTile* tile_;
    BoundedGeometry bound_;
    const core::Medium* medium_ = nullptr;  ///< of the first lane in one; null: of none
    Lanes own_half_{},
        scale_{};         ///< half of the extinction at a receiver; where `medium_` is not its medium, all
    Lanes other_half_{};  ///< 1/2 where that at the light counts, else 0
};

}  // namespace mote::lights
