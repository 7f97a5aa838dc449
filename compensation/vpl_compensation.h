// Compensation from the virtual point lights, for the sixteen receivers of a tile.
//
// Receivers in media follow the strategies of Sec. 10.2.3 of Engelhardt 2013; on surfaces one vertex is
// joined to all VPLs (Kollig and Keller 2006), as in that thesis.
// The strategies: a vertex joined to all VPLs, or one vertex for each VPL.
// (The loop that Sec. 10.7 marks N-to-1 is the former; see docs/errata.md.) A 1-to-1 strategy is the latter
// where every VPL has its own receiver; which VPLs a receiver meets is in the range.
#pragma once

#include <array>

#include "compensation/residual_transport.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::compensation {

/// A receiver of the tile that is to be compensated.
struct CompensatedReceiver {
    ResidualPath path;               ///< from the receiver on
    core::Rng rng;                   ///< of the lane
    std::int32_t max_vpl_depth = 0;  ///< of VPLs at the receiver itself; 0: an idle lane
};
/// The sixteen lanes of a tile.
using CompensatedTile = std::array<CompensatedReceiver, lights::ReceiverLanes::width>;

/// Memory that one task reuses, and what it counted.
struct VplCompensationScratch {
    lights::ReceiverTile tile;                                     ///< the vertices that VPLs are gathered at
    std::array<ResidualPath, lights::ReceiverLanes::width> paths;  ///< of the steps, by lane
    std::uint64_t vertices = 0;                                    ///< that steps have made
};

/// Arguments of compensation: the light of the VPLs of `range`, over `steps` steps at most (-1: no limit).
struct VplCompensation {
    const ResidualTransport& transport;  ///< takes the steps
    Strategy strategy;                   ///< how VPLs meet vertices
    int steps;                           ///< at most; -1: no limit
    const lights::VplSet& vpls;          ///< whose light is brought back
    lights::VplRange range;              ///< of them
};

/// Compensation from the VPLs per lane. Vertices are gathered by `gather`, which counts where `context` does.
template <bool Media>
lights::TileLight compensation_from_vpls(const VplCompensation& request, CompensatedTile& receivers,
                                         VplCompensationScratch& scratch, const lights::GatherContext& gather,
                                         core::WalkContext& context);

}  // namespace mote::compensation
