#include "lights/virtual_lights/virtual_point_light.h"

namespace mote::lights {

using namespace core;

namespace {

float correction_of(const ScatteringVertex& v) {
    if (!v.on_surface()) return 1.0f;
    const float geometric = std::fabs(glm::dot(v.wo, v.hit.geometric_normal));
    return geometric > 0.0f ? std::fabs(glm::dot(v.wo, v.hit.shading.n)) / geometric : 0.0f;
}

}  // namespace

float VplDetail::incoming_correction() const { return correction_of(vertex); }

Rgb VplDetail::eval(const Vec3& to_receiver, float peak_limit) const {
    return vertex.eval(to_receiver, TransportMode::power, peak_limit) * incoming_correction();
}

MediumState VplSet::state_towards(std::size_t light, const Vec3& direction) const {
    if (states.empty()) return {};
    const std::uint32_t detail =
        lights[light].detail;  // without one it shines to the side its light came from
    return detail == VirtualPointLight::no_detail
               ? states[light]
               : details[detail].vertex.state_towards(states[light], direction);
}

void append_vpl(VplSet& set, const ScatteringVertex& vertex, const Rgb& alpha, std::uint32_t depth,
                std::uint32_t path) {
    if (is_black(alpha) || !vertex.connectable()) return;
    VirtualPointLight vpl;
    vpl.depth = depth, vpl.path = path, vpl.position = vertex.position, vpl.intensity = alpha;
    bool plain;
    if (vertex.on_surface()) {
        // A plain VPL shines on the side the light came from.
        const bool front = glm::dot(vertex.hit.geometric_normal, vertex.wo) > 0.0f;
        vpl.normal = front ? vertex.hit.geometric_normal : -vertex.hit.geometric_normal;
        vpl.shading_normal = front ? vertex.hit.shading.n : -vertex.hit.shading.n;
        vpl.position = offset_origin(vertex.hit, vpl.normal);
        const auto reflectance = vertex.diffuse_reflectance();
        plain = reflectance.has_value();
        if (plain) {
            // The light must also arrive above the shading normal, or a diffuse surface reflects nothing.
            if (glm::dot(vpl.shading_normal, vertex.wo) <= 0.0f) return;
            // f* is a constant, and I_j one colour (Engelhardt 2013, Eq. 10.3).
            vpl.intensity *= *reflectance * inv_pi * correction_of(vertex);
        }
    } else {
        plain = vertex.phase->isotropic();
        if (plain) vpl.intensity *= inv_four_pi;
    }
    if (is_black(vpl.intensity)) return;
    if (!plain) {
        vpl.detail = std::uint32_t(set.details.size());
        set.details.push_back({vertex});
    }
    set.lights.push_back(vpl);
}

}  // namespace mote::lights
