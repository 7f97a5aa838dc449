// Choice of the lights that each of sixteen receivers connects to, by importance.
//
// All evaluate the importance of one set of candidates, sixteen receivers at once (line_importance.h). A
// receiver then walks along its own prefix sum of importances, in equal steps from a random start, and
// connects to the light at every step: to a light of large importance several times, to one of small
// importance by chance. Every connection carries about one step of light, be it from ray lights or from VPLs,
// and a receiver of little light has few of them.
#pragma once

#include <vector>

#include "lights/ray_lights/line_importance.h"

namespace mote::lights {

/// A light that a receiver connects to.
struct LineChoice {
    std::uint32_t light;  ///< its index
    bool ray;             ///< true: a ray light, false: a VPL
    float weight;         ///< 1 / expected number of connections
};

/// By lane.
using LineChoices = std::array<std::vector<LineChoice>, ReceiverLanes::width>;

/// Candidates of a tile, with their importances by lane.
class LineCandidates {
  public:
    /// Removes all candidates.
    void clear() { lights_.clear(), expected_.clear(), total_ = {}; }
    /// Appends a light of this weight, with its importance for each lane.
    void add(std::uint32_t light, bool ray, float weight, const core::Lanes& expected);
    /// Sum of all importances, by lane.
    const core::Lanes& total() const { return total_; }
    /// Lights that lanes connect to, each by steps of `steps` through the sum of importances from `starts`
    /// (relative to the first step). A step of 0 connects once to every light of positive importance; a start
    /// of 1 or more connects to none.
    void choose(const core::Lanes& steps, const core::Lanes& starts, LineChoices& choices) const;

  private:
    std::vector<LineChoice> lights_;
    std::vector<core::Lanes> expected_;
    core::Lanes total_;
};

}  // namespace mote::lights
