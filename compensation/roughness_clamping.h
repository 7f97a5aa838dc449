// Roughness clamping (Tokuyoshi & Ogaki 2012, Sec. 5): lobes of glossy surfaces that are narrower than the
// light around them is known are widened, for each pair of a receiver and a virtual point light.
//
// A lobe is taken for a kernel over directions: D may not be higher than the density of directions around a
// sample, over m = m' f cos / D (Eq. 9), so that no sample has more than 1/m' of the light. m cancels D: what
// is limited is the peak of f cos, to d^/m' [1/sr].
//   1/d^_j = 1/d_j,0 + 1/d_j,3,    d^_3 = d_3,j                                        (Eqs. 13 and 17)
//   d_3,j = d_j,3 = d_A |x_j - x_3|^2 / C(j -> 3),  d_j,0 = d_A |x_j - x_0|^2 / C(j -> 0)   (Eqs. 15 and 16)
// The paper has one VPL from one light and d_A = N p_e C / |x_j - x_0|^2. Here any number of paths passes a
// place after any number of bounces, and d_A is found as Christensen 1999 does: m' neighbours within r_j,
// d_A / m' = 1 / (pi r_j^2). So a lobe covers the disc that the m' nearest lights share.
//
// Biased: sharp reflections are blurred, and some models reflect less light when they are rough. More passes
// do not change it, more light paths a pass do.
#pragma once

#include "lights/virtual_lights/virtual_point_light.h"

namespace mote::compensation {

struct RoughnessClamping {
    bool enabled = false;
    std::uint32_t neighbours = 16;  ///< m'
};

/// Fills VplSet::peak_density. `fraction`: of the lights, those that a receiver meets. VPLs in media have no
/// neighbours: what they light is not clamped.
void clamp_roughness(lights::VplSet& vpls, const RoughnessClamping& clamping, float fraction = 1.0f);

}  // namespace mote::compensation
