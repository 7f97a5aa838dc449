// What a group of lights sends to sixteen receivers, or groups of them: at most, and about.
//
// Both are products of the energy of the group, the weights of a lane and, for each lane, f* and C* of both
// ends over d^2, where every factor is taken at its best place in the group:
//   d from the box of the differences of positions;
//   a cosine to an axis n is at most  max n.(y - x) / d,  in the box, and that to any axis of a cone around n
//   is at most the cosine of the angle less the cone's;
//   f* is constant, or Henyey-Greenstein's function at such a cosine, or Bsdf::eval_bound().
#pragma once

#include <array>

#include "lights/selection/light_node.h"
#include "lights/selection/receiver_bounds.h"

namespace mote::lights {

/// By lane, averages over the channels.
struct alignas(64) LaneValues {
    std::array<float, ReceiverLanes::width> value{};
    float sum() const {
        float s = 0.0f;
        for (const float v : value) s += v;
        return s;
    }
};

/// At least the sum over the lights j of the group of  f*(x) min(G*(x,y_j), b) I_j  for every receiver x of a
/// lane, in any channel less than three times this, and in their average less than this. `bound`: b [1/m^2],
/// infinity for none. Infinite where nothing better is known.
LaneValues most_light(const LightNode& node, const ReceiverBounds& receivers, float bound);

/// About what it sends, for choosing among groups: 0 only where nothing can arrive, and finite. The distance
/// is that of the middles, and at least half the diagonal of the group.
LaneValues expected_light(const LightNode& node, const ReceiverBounds& receivers, float bound);

/// Both at once.
void bound_light(const LightNode& node, const ReceiverBounds& receivers, float bound, LaneValues& most,
                 LaneValues& expected);

}  // namespace mote::lights
