// Callbacks of the eye paths of `mote_vpl_ray_bundles`: virtual point lights are gathered at vertices, and
// bundles of rays start.
#pragma once

#include "core/render/cpu_clock.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/vpl_ray_bundles/vpl_bundle_pass.h"

namespace mote::integrators {

/// Where the time of a pass goes, in seconds of its threads.
struct VplBundleTime {
    double eye = 0.0, vpls = 0.0, bundles = 0.0;
};

class VplBundleTile {
  public:
    using Packet = EyePacket<false>;
    static_assert(Packet::width == lights::ReceiverTile::width);

    VplBundleTile(const VplBundleSettings& settings, const VplBundlePass& pass, Packet& packet);

    /// Follows the eye paths, and gathers at the vertices of the pixels' first ones.
    void run(const PacketPixels& pixels);
    /// Adds what was gathered to the pixels.
    void add_gathered(const PacketPixels& pixels, core::PassImage& image) const;
    const VplBundleTime& time() const { return time_; }

  private:
    struct Gathered {
        core::Rgb indirect{0.0f}, direct{0.0f};
    };
    void receive(int index, Packet::Lane& lane);
    void gather(const PacketPixels& pixels);

    const VplBundleSettings& settings_;
    const VplBundlePass& pass_;
    Packet& packet_;
    core::WalkContext& walk_;
    std::unique_ptr<lights::GatherScratch> scratch_;
    gathering::EyeBundles bundles_;
    lights::ReceiverTile tile_;
    gathering::ReceiverArray receivers_;
    core::Rng bundle_rng_;  ///< of a step's bundles
    std::array<Gathered, Packet::width> gathered_;
    VplBundleTime time_;
};

}  // namespace mote::integrators
