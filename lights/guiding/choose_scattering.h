// The next vertex of a path, sampled among the places where a segment may scatter: candidates in media
// (core/scene/scattering_points.h) and the surface behind them.
//
// Xu et al. 2024 guide the probability that a path scatters in a volume before the surface; as the radiance
// that is expected at each candidate is known too, the same choice guides the distance (Herholz et al. 2019).
// With w the weight of a place, transmittance and scattering coefficient over density, and L the root of the
// second moment of the radiance expected there,
//   P = (1 - d) w L / sum w L + d w / sum w,
// a defensive mixture with extinction. A path that is divided by P stays unbiased whatever L is.
#pragma once

#include <span>

#include "core/scene/scattering_points.h"
#include "lights/guiding/scattering_guide.h"

namespace mote::lights {

/// Probability d of a choice by extinction alone, in the defensive mixture.
inline constexpr float extinction_share = 0.2f;

/// A place where a path scatters next.
struct ScatteringChoice {
    std::size_t index = 0;       ///< of a candidate; their number: the surface
    float probability = 0.0f;    ///< 0: there is no place
    float by_extinction = 0.0f;  ///< probability by extinction alone
    float expected = 0.0f;       ///< mean radiance expected from all places, times the path's weights there
    float indirect = 0.0f;       ///< of the chosen place: ExpectedRadiance::indirect
    bool known = false;          ///< false: nothing was learned, and what is expected is of no use
};

/// Samples a place by `u`; of ScatteringPoints::max_candidates at most. `behind`: weight of the path at the
/// surface; black where there is none.
ScatteringChoice choose_scattering(std::span<const core::ScatteringPoint> candidates, const core::Rgb& behind,
                                   const core::Vec3& surface, const ScatteringGuide& guide, float u);

}  // namespace mote::lights
