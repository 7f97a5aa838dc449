#include "lights/virtual_lights/vpl_receivers.h"

namespace mote::lights {

using namespace core;

void ReceiverTile::clear() {
    for (int i = 0; i < width; ++i) {
        max_vpl_depth[i] = 0, directional[i] = nullptr;
        weight_r[i] = weight_g[i] = weight_b[i] = 0.0f;
    }
    any_directional = any_active = false;
}

void ReceiverTile::set(int lane, const ScatteringVertex& vertex, const Rgb& throughput,
                       const MediumState& medium_state, const Rng& tracking_rng, std::int32_t max_depth) {
    Rgb weight = throughput;
    Vec3 position = vertex.position, ns(0.0f), ng(0.0f);
    directional[lane] = nullptr;
    if (vertex.on_surface()) {
        const bool front = glm::dot(vertex.hit.geometric_normal, vertex.wo) > 0.0f;
        ng = front ? vertex.hit.geometric_normal : -vertex.hit.geometric_normal;
        ns = front ? vertex.hit.shading.n : -vertex.hit.shading.n;
        position = offset_origin(vertex.hit, ng);
        const auto reflectance = vertex.diffuse_reflectance();
        if (!reflectance)
            directional[lane] = &vertex;
        else if (glm::dot(ns, vertex.wo) > 0.0f)
            weight *= *reflectance * inv_pi;
        else
            weight = Rgb(0.0f);  // seen from below the shading normal
    } else if (vertex.phase->isotropic()) {
        weight *= inv_four_pi;
    } else {
        directional[lane] = &vertex;
    }
    x[lane] = position.x, y[lane] = position.y, z[lane] = position.z;
    shading_x[lane] = ns.x, shading_y[lane] = ns.y, shading_z[lane] = ns.z;
    geometric_x[lane] = ng.x, geometric_y[lane] = ng.y, geometric_z[lane] = ng.z;
    in_medium[lane] = vertex.on_surface() ? 0.0f : 1.0f;
    weight_r[lane] = weight.x, weight_g[lane] = weight.y, weight_b[lane] = weight.z;
    max_vpl_depth[lane] = max_depth;
    state[lane] = medium_state;
    rng[lane] = tracking_rng;
    any_directional |= directional[lane] != nullptr;
    any_active = true;
}

}  // namespace mote::lights
