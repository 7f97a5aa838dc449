// Sets of a tile's receivers that share a shadow ray: those that lie so close together that a light hardly
// distinguishes them.
//
// Receivers are joined pair by pair, those first whose set stays smallest (complete linkage), so every stage
// is a partition into sets of a known diameter. Those of a surface lie on one face, those of media beside
// each other. Seen from a light at distance d a set of diameter D covers an angle of about D / d.
#pragma once

#include <array>
#include <cstdint>

#include "lights/virtual_lights/vpl_receivers.h"

namespace mote::lights {

class ReceiverSets {
  public:
    static constexpr int width = ReceiverLanes::width;
    static constexpr std::uint8_t none = 0xff;

    ReceiverSets() = default;
    explicit ReceiverSets(const ReceiverLanes& receivers);

    /// By lane, the lane that names its set; none for idle lanes. Sets of the coarsest partition whose
    /// diameters are at most `diameter` [m]; at most 0: every lane is alone.
    const std::array<std::uint8_t, width>& within(float diameter) const {
        int stage = 0;
        if (diameter > 0.0f)
            while (stage + 1 < stages_ && diameter_[std::size_t(stage) + 1] <= diameter) ++stage;
        return set_of_[std::size_t(stage)];
    }
    int stages() const { return stages_; }  ///< one more than sets were joined

  private:
    int stages_ = 0;
    std::array<float, width> diameter_{};  ///< of the largest set of a stage
    std::array<std::array<std::uint8_t, width>, width> set_of_{};
};

}  // namespace mote::lights
