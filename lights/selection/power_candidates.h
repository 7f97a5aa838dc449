// Candidates for resampling by what lights send in all: the proposal that looks at no receiver.
//
// Lights stand in the order of the hierarchy, where neighbours are alike, so one random number in each n-th
// of the whole power is spread over places, too. A table of where each share of the power begins makes a
// draw a look into it and a step or two.
#pragma once

#include <span>
#include <vector>

#include "core/math/random.h"
#include "lights/selection/light_hierarchy.h"
#include "lights/virtual_lights/vpl_choice.h"

namespace mote::lights {

class PowerCandidates {
  public:
    /// Keeps a reference.
    explicit PowerCandidates(const LightHierarchy& lights);

    /// Appends n lights, each with 1 / (n p); a light that is drawn more than once comes once, and counts so
    /// often. Nothing where there are no lights.
    void draw(std::uint32_t n, core::Rng& rng, std::vector<WeightedVpl>& drawn) const {
        draw(lights_.root(), n, rng, drawn);
    }
    /// The same among the lights of a group.
    void draw(const LightCluster& group, std::uint32_t n, core::Rng& rng,
              std::vector<WeightedVpl>& drawn) const;
    /// Of the light at a place in the order of the hierarchy.
    double probability(std::uint32_t place) const {
        return (sums_[place] - (place > 0 ? sums_[place - 1] : 0.0)) / sums_.back();
    }
    static constexpr std::size_t bytes_a_light = sizeof(double) + sizeof(std::uint32_t);
    std::size_t memory_bytes() const {
        return sums_.size() * sizeof(double) + begins_.size() * sizeof(std::uint32_t);
    }

  private:
    const LightHierarchy& lights_;
    std::vector<double> sums_;  ///< of the energies of lights, this one included
    /// By share of the power: a place at or before the first one whose sum is above its beginning.
    std::vector<std::uint32_t> begins_;
};

}  // namespace mote::lights
