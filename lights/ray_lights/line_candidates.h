// Which lights each of sixteen receivers connects to: drawn by what they would send to it, about.
//
// All look at the same lights, so that looking costs little (line_importance.h). A receiver then walks along
// its own sum of what these would send, in equal steps from a random start, and connects to the light at
// every step: to a light that sends much several times, to one that sends little by chance. Every connection
// carries about one step of light, be it from ray lights or from VPLs, and a receiver of little light has few
// of them.
#pragma once

#include <vector>

#include "lights/ray_lights/line_importance.h"

namespace mote::lights {

/// A light that a receiver connects to.
struct LineChoice {
    std::uint32_t light;  ///< its index
    bool ray;             ///< is it a ray light, or a VPL?
    float weight;         ///< how often it counts
};

/// By lane.
using LineChoices = std::array<std::vector<LineChoice>, ReceiverLanes::width>;

/// Lights on candidates to a tile.
class LineCandidates {
  public:
    /// Nothing is on candidates.
    void clear() { lights_.clear(), expected_.clear(), total_ = {}; }
    /// A light that counts `weight` times, and what it would send to each lane.
    void add(std::uint32_t light, bool ray, float weight, const LaneFloats& expected);
    /// Of all, by lane.
    const LaneFloats& total() const { return total_; }
    /// What lanes connect to, each with steps of `steps` from a start within the first one; a step of 0: to
    /// all that send any light, once. Of lanes with a start of 1 or more, to nothing.
    void choose(const LaneFloats& steps, const LaneFloats& starts, LineChoices& choices) const;

  private:
    std::vector<LineChoice> lights_;
    std::vector<LaneFloats> expected_;
    LaneFloats total_;
};

}  // namespace mote::lights
