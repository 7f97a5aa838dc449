// The residual operator as a sum over the pixels of a picture (Engelhardt 2013, Sec. 11.2).
//
//   E(y) = 1/pi sum_i max(G(y, z_i) - b, 0) A_i L_i                    Eq. 11.5 for diffuse surfaces
//
// E times the reflectance at y is T_r L. Visibility is left out: what is nearer than b^(-1/2) is rarely
// hidden. Once over all pixels, the reference, and once over the nodes of a mip pyramid.
#pragma once

#include <cstdint>
#include <span>

#include "core/objects/cancellation.h"
#include "screenspace/ssbc/mip_pyramid.h"
#include "screenspace/ssbc/ssbc_residual.h"

namespace mote::screenspace {

/// When a node is replaced by its children (Engelhardt 2013, Sec. 11.2.2).
struct RefinementRules {
    float projected_angle = 0.08f;                ///< refine what appears larger than this [sr]
    float discontinuity_projected_angle = 0.04f;  ///< for a node that spans a discontinuity [sr]
    int levels = 6;                               ///< of the pyramid that may be summed; 1: pixels alone
    int splits = 6;  ///< a pixel's patch that appears larger may be halved this often, one after the other
    /// Apparent size of a node: at most, by its bounds, or as the paper has it, by its mean position and
    /// normal. The mean of two walls that meet faces neither, and what lies beside the receiver is missed.
    enum class Estimate : std::uint8_t { at_most, at_mean } estimate = Estimate::at_most;
    core::CancelToken cancelled = {};  ///< throws Cancelled
};

struct SumCounts {
    std::uint64_t receivers = 0;
    std::uint64_t samples = 0;  ///< nodes or pixels that were added up, over all receivers
    std::uint64_t visits = 0;   ///< visited nodes, those added up among them
    std::uint64_t limited = 0;  ///< receivers whose form factors added up to more than one
    void operator+=(const SumCounts& other);
};

/// Sums for one picture and bound b [1/m^2]; b must not be negative.
struct ResidualSum {
    const SurfacePyramid& surfaces;
    const LightPyramid& light;
    float bound;

    /// E at the receivers, from every pixel of the picture; of the rules, those for pixels apply.
    SumCounts flat(const RefinementRules& rules, std::span<const SsbcReceiver> receivers,
                   std::span<core::Rgb> irradiance) const;
    /// Sum over nodes. Receivers are taken in packets that refine together, so neighbours should be next
    /// to each other: a node that one of them must refine is refined for all.
    SumCounts hierarchical(const RefinementRules& rules, std::span<const SsbcReceiver> receivers,
                           std::span<core::Rgb> irradiance) const;
};

}  // namespace mote::screenspace
