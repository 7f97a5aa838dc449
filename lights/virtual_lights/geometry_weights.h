// Weights of the geometry term between a receiver x and a virtual point light y.
//
// A policy is called with G*(x,y) = C*(x->y) C*(y->x) / |x-y|^2 [1/m^2], the squared distance [m^2] and the
// two C*, and returns G* times its weight. It is called in the sixteen-lane loop and must be straight
// arithmetic. A technique that is weighted against another one is a policy too: its weight is a function of
// the same four numbers, or of more: with for_pair(receivers, vpls, index) it is made anew for every light,
// and a policy that takes a fifth number receives the lane.
#pragma once

#include "core/math/vectorize.h"

namespace mote::lights {

/// Weighted geometry term of one lane.
template <typename Weight>
float weighted_geometry(const Weight& weight, float g, float d2, float cos_x, float cos_y,
                        [[maybe_unused]] int lane) {
    if constexpr (requires { weight(g, d2, cos_x, cos_y, lane); })
        return weight(g, d2, cos_x, cos_y, lane);
    else
        return weight(g, d2, cos_x, cos_y);
}

/// All of G*.
struct UnboundedGeometry {
    /// G*.
    float operator()(float g, float, float, float) const { return g; }
};

/// min(G*, b) (Engelhardt 2013, Sec. 10.1.3); `bound` is b [1/m^2], infinity for all.
struct BoundedGeometry {
    float bound;  ///< b [1/m^2], above 0; infinity: none
    /// G*, at most b.
    float operator()(float g, float, float, float) const { return core::min_of(g, bound); }
};

/// max(0, G* - b) = B* G*: what BoundedGeometry leaves out (Eq. 10.10 with the bound that it does not print).
struct ResidualGeometry {
    float bound;  ///< b [1/m^2]
    /// Part of G* above b.
    float operator()(float g, float, float, float) const { return core::max_of(0.0f, g - bound); }
};

}  // namespace mote::lights
