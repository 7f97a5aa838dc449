// Gathering: the light of all VPLs at sixteen receivers at once.
//
// Engelhardt 2013, Eqs. 10.4 and 10.5 with the bounded geometry term of Sec. 10.1.3:
//   sum over j of  f*(x) min(G*(x,y_j), b) V*(x,y_j) I_j
// Receivers are the first connectable vertices of a 4x4 tile of pixels, on surfaces and in media mixed; f* of
// a diffuse surface or an isotropic medium is a constant, so the loop over plain VPLs is straight arithmetic
// on sixteen lanes, and all shadow rays of a batch of VPLs go to Embree in one call.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lights/virtual_lights/virtual_point_light.h"

namespace mote::lights {

/// Where sixteen receivers stand and what they make of light: all that a connection needs but its visibility.
struct alignas(64) ReceiverLanes {
    static constexpr int width = core::ShadowPacket::width;

    // Position moved off the surface towards the viewer: the start of shadow rays.
    float x[width] = {}, y[width] = {}, z[width] = {};
    // Shading and geometric normal on the viewer's side; zero in a medium.
    float shading_x[width] = {}, shading_y[width] = {}, shading_z[width] = {};
    float geometric_x[width] = {}, geometric_y[width] = {}, geometric_z[width] = {};
    float in_medium[width] = {};  ///< 1 in a medium, else 0
    // Path throughput, times f* where that is a constant.
    float weight_r[width] = {}, weight_g[width] = {}, weight_b[width] = {};
    std::int32_t max_vpl_depth[width] = {};  ///< VPLs deeper than this are left out; 0 for an idle lane

    const core::ScatteringVertex* directional[width] = {};  ///< set where f* depends on direction
    bool any_directional = false;
    bool any_active = false;
};

struct alignas(64) ReceiverTile : ReceiverLanes {
    core::MediumState state[width];  ///< media at the receiver
    core::Rng rng[width];            ///< for transmittance estimates

    /// Fills a lane. `throughput` is the weight of the eye path; `vertex` must outlive the tile when f*
    /// depends on direction.
    void set(int lane, const core::ScatteringVertex& vertex, const core::Rgb& throughput,
             const core::MediumState& medium_state, const core::Rng& tracking_rng, std::int32_t max_depth);
    void clear();
};

/// Memory that one task reuses between tiles: a batch of shadow rays with what they would carry.
class GatherScratch {
  public:
    static constexpr int batch = 32;
    std::array<core::ShadowPacket, batch> packets;
    struct alignas(64) Contribution {
        float r[ReceiverTile::width], g[ReceiverTile::width], b[ReceiverTile::width];
        const VirtualPointLight* vpl;
    };
    std::array<Contribution, batch> contributions;
    GatherScratch();
};

/// Which VPLs of a set: every `stride`-th from `first` on, before `end`.
struct VplRange {
    std::size_t first = 0, stride = 1, end = std::size_t(-1);

    static VplRange one(std::size_t index) { return {index, 1, index + 1}; }
};

/// What one VPL would send to the receivers if nothing stood between them, into `out`, and the shadow rays
/// into `packet`, which has been cleared once. Returns whether any lane receives light; else nothing of
/// `packet` counts.
bool connect(const ReceiverLanes& receivers, const VplSet& vpls, const VirtualPointLight& vpl, float bound,
             core::ShadowPacket& packet, GatherScratch::Contribution& out);

/// Light of the VPLs in `range` at the receivers of a tile, per lane. `bound` is b [1/m^2], infinity for
/// unbounded. Counts shadow rays and tracking.
std::array<core::Rgb, ReceiverTile::width> gather(const core::Scene& scene, const VplSet& vpls,
                                                  const VplRange& range, float bound, ReceiverTile& tile,
                                                  GatherScratch& scratch, core::RayCounters& rays,
                                                  core::TrackingCounters& tracking);

}  // namespace mote::lights
