// Callbacks of the eye paths of `mote_micro_rendering`: vertices gather the light of points with a
// micro-buffer each.
#pragma once

#include <array>

#include "gathering/stored_light/micro_receiver.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/micro_rendering/micro_settings.h"

namespace mote::integrators {

class MicroEyeTile {
  public:
    using Packet = EyePacket<false>;

    MicroEyeTile(const MicroSettings& settings, const gathering::LitPoints& points, Packet& packet)
        : settings_(settings),
          points_(points),
          packet_(packet),
          texels_(std::size_t(Packet::width) * points.buffers().texels_each()),
          weights_(points.buffers().texels_each()) {}

    /// Advances the paths of the packet to their ends; `gathers` false: only records their receivers.
    void run(bool gathers);
    std::uint64_t receivers() const { return receivers_; }  ///< so far

  private:
    using Lanes = std::span<Packet::Lane* const>;
    bool receives(Packet::Lane& lane) const;
    void gather(bool gathers);
    void gather_diffuse(Lanes lanes);
    void gather_glossy(Lanes lanes);
    static gathering::MicroReceiver receiver_of(Packet::Lane& lane);

    const MicroSettings& settings_;
    const gathering::LitPoints& points_;
    Packet& packet_;
    std::vector<gathering::MicroReceiver> group_;  ///< receivers of the lanes that gather together
    std::vector<gathering::BrdfWarp> warps_;
    std::vector<gathering::MicroTexel> texels_;
    std::vector<core::Rgb> weights_;
    std::uint64_t receivers_ = 0;
};

}  // namespace mote::integrators
