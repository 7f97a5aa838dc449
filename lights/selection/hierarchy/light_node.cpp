#include "lights/selection/hierarchy/light_node.h"

namespace mote::lights {

using namespace core;

LightNode united(const LightNode& a, const LightNode& b) {
    LightNode n;
    n.lower = glm::min(a.lower, b.lower), n.upper = glm::max(a.upper, b.upper);
    n.energy = a.energy + b.energy;
    n.peak = std::max(a.peak, b.peak);
    n.min_depth = std::min(a.min_depth, b.min_depth);
    const auto on_surface = [](const LightNode& x) {
        return x.kind == LightKind::surface || x.kind == LightKind::glossy;
    };
    n.kind = a.kind == b.kind                 ? a.kind
             : on_surface(a) && on_surface(b) ? LightKind::glossy
                                              : LightKind::mixed;
    if (n.kind == LightKind::glossy) {
        const float most = std::max(a.peak * a.peak_times_cosine(), b.peak * b.peak_times_cosine());
        n.set_grazing(most);
    } else {
        n.g_low = std::min(a.g_low, b.g_low), n.g_high = std::max(a.g_high, b.g_high);
    }
    // Cones hold the error of their code already; what is added once more is 0.01 degrees a level.
    n.set_cone(n.kind == LightKind::mixed ? DirectionCone::all() : core::united(a.cone(), b.cone()));
    return n;
}

}  // namespace mote::lights
