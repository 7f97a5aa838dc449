// Candidates for resampling from the groups of a cut: which groups may matter is asked of bounds, which
// lights of a group, of their power alone.
//
// The cut is that of stochastic lightcuts (light_sampler.h): the group that is expected to send most is
// parted first. Going down from a group to one of its lights takes longer than making the cut, and what
// differs within a group the target function of resampling knows anyway: so a group gives several lights, by
// power.
#pragma once

#include "lights/selection/power_candidates.h"
#include "lights/selection/receiver_bounds.h"

namespace mote::lights {

class GroupCandidates {
  public:
    /// From each group: so many.
    static constexpr std::uint32_t lights_a_group = 8;

    /// Appends about n lights, right in the mean: n / 8 groups, 8 of each. `bound`: b of the geometry term.
    void draw(const LightHierarchy& lights, const PowerCandidates& power, const ReceiverBounds& receivers,
              float bound, std::uint32_t n, core::Rng& rng, std::vector<WeightedVpl>& drawn);

  private:
    struct Group {
        LightCluster cluster;
        float expected;
    };
    std::vector<Group> cut_;  ///< a heap
};

}  // namespace mote::lights
