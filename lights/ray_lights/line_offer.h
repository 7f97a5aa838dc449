// Which lights each of sixteen receivers connects to: drawn by what they would send to it, about.
//
// All look at the same lights, so that looking costs little (expected_light.h). A receiver then walks along
// its own sum of what these would send, in equal steps from a random start, and connects to the light at
// every step: to a light that sends much several times, to one that sends little by chance. Every connection
// carries about one step of light, be it from ray lights or from VPLs, and a receiver of little light has few
// of them.
#pragma once

#include <vector>

#include "lights/ray_lights/expected_light.h"

namespace mote::lights {

/// A light that a receiver connects to.
struct LinePick {
    std::uint32_t light;  ///< its index
    bool ray;             ///< is it a ray light, or a VPL?
    float weight;         ///< how often it counts
};

/// By lane.
using LinePicks = std::array<std::vector<LinePick>, ReceiverLanes::width>;

/// Lights on offer to a tile.
class LineOffer {
  public:
    /// Nothing is on offer.
    void clear() { lights_.clear(), expected_.clear(), total_ = {}; }
    /// A light that counts `weight` times, and what it would send to each lane.
    void add(std::uint32_t light, bool ray, float weight, const LaneFloats& expected);
    /// Of all, by lane.
    const LaneFloats& total() const { return total_; }
    /// What lanes connect to, each with steps of `steps` from a start within the first one; a step of 0: to
    /// all that send any light, once. Of lanes with a start of 1 or more, to nothing.
    void pick(const LaneFloats& steps, const LaneFloats& starts, LinePicks& picks) const;

  private:
    std::vector<LinePick> lights_;
    std::vector<LaneFloats> expected_;
    LaneFloats total_;
};

}  // namespace mote::lights
