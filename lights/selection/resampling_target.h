// The target function of resampling: what a virtual point light is thought to send to a receiver.
//
// Luminance of f*(x) min(G*(x,y_j), b) I_j, times the throughput of the eye path, as if no surface stood
// between, and times a guess of the transmittance, where t is the distance times the mean of the extinctions
// at both ends: 1 / (1 + t + t^2/2 + t^3/6) in a homogeneous medium, which is nearly e^-t, and 1 / (1 + t) in
// others. It falls slowly since t may be wrong: what it takes for dark is chosen less often, and counts the
// more when it is. The function is 0 only where no light arrives.
//
// Lobes in media are looked at for sixteen lanes at once (lobe_contributions.h) where nobody has to know the
// target again: it is the same but for rounding. Where tiles are reused it has to be the same whenever it is
// asked (`exact`), and glossy surfaces always ask their BSDF, lane by lane.
#pragma once

#include "lights/selection/lobe_contributions.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// Sixteen receivers, as the target function sees them.
class ResamplingTarget {
  public:
    static constexpr int width = ReceiverLanes::width;
    using Lanes = std::array<float, width>;

    /// Keeps references to all. `bound`: b [1/m^2], infinity for none. `attenuates`: whether there are media.
    ResamplingTarget(const VplSet& vpls, const ReceiverTile& tile, float bound, bool attenuates, bool exact);

    /// The target times the weight of the light. Returns false, and nothing counts, where it is 0 everywhere.
    bool of_light(const WeightedVpl& light, GatherScratch& scratch, Lanes& out) const {
        return of_light(light, extinction_at(vpls_->lights[light.index].position), scratch, out);
    }
    /// The same where the extinction at the light is known (0 if medium() is null). If not `exact`, that
    /// between is looked at, too.
    bool of_light(const WeightedVpl& light, float extinction, GatherScratch& scratch, Lanes& out) const;
    const core::Medium* medium() const { return medium_; }  ///< whose extinction at lights counts
    float extinction_at(const core::Vec3& light) const;
    /// The same of one lane, with the light that arrives and its shadow ray.
    struct Connection {
        core::Rgb light{0.0f};
        core::Vec3 origin{0.0f}, target{0.0f};
        float value = 0.0f;
    };
    /// Not `guesses`: without the guess of the transmittance.
    Connection of_lane(int lane, std::size_t light, bool guesses = true) const;

    /// 1 over the luminance of what a lane does to all light: it makes targets of different receivers alike.
    float scale(int lane) const { return scale_[std::size_t(lane)]; }
    const ReceiverTile& tile() const { return *tile_; }

  private:
    const VplSet* vpls_;
    const ReceiverTile* tile_;
    BoundedGeometry bound_;
    const core::Medium* medium_ = nullptr;  ///< of the first lane in one; null: of none
    std::optional<ReceiverLobes> lobes_;    ///< of the tile; nothing: every pair asks for itself
    float fast_ = 0.0f;                     ///< how the guess of the transmittance falls
    Lanes own_half_{},
        scale_{};         ///< half of the extinction at a receiver; where `medium_` is not its medium, all
    Lanes other_half_{};  ///< 1/2 where that at the light counts, else 0
};

}  // namespace mote::lights
