// Several samples of lights at one vertex, and how many.
//
// At the first two vertices of a path they lower a picture's error by more than their shadow rays cost, at
// later ones by less. n samples of density p_i each are weighted as one technique of density n p_i (Veach
// 1997, Eq. 9.8), and added up.
#pragma once

#include <algorithm>

#include "core/math/vec.h"

namespace mote::core {
class Scene;
}

namespace mote::integrators {

/// Samples of lights at the first vertices of an eye path.
struct LightSamples {
    int surfaces = 1;
    int media = 1;
    /// At a vertex behind so many scatterings.
    int at(int scatterings, bool on_surface) const {
        if (scatterings > 1) return 1;
        return on_surface ? surfaces : media;
    }
    int at_most() const { return std::max(surfaces, media); }
};

/// One where all samples were the same: of a single light without extent; else two, so that among two lights
/// both are sampled. One at vertices in media where transmittance has to be looked up: there distances and
/// transmittances leave the noise, not lights.
LightSamples light_samples_for(const core::Scene& scene);

/// Random numbers of one sample, in [0, 1).
struct LightNumbers {
    float choice;      ///< among the lights
    core::Vec2 point;  ///< on the light
};

/// Those of sample k of n: the first's, moved by equal steps through the lights and along the Kronecker
/// sequence of the plastic number over the light. Each alone is distributed as the first.
LightNumbers numbers_of_light(const LightNumbers& first, int k, int n);

}  // namespace mote::integrators
