#include "lights/virtual_lights/vpl_contributions.h"

namespace mote::lights {

using namespace core;

namespace {

/// d^/m' at both ends of a connection [1/sr]; infinity where nothing is clamped.
struct PeakLimits {
    float at_receiver = infinity, at_light = infinity;
};

/// Tokuyoshi & Ogaki 2012, Eqs. 13 and 15 to 17, with the density of lights per area around y_j as it is
/// found, instead of that of one path: a neighbour of y_j is seen from x in another direction, and sees x and
/// the vertex before it in others. The eye is a point (infinite density).
PeakLimits peak_limits(const VplSet& vpls, const VirtualPointLight& vpl, const VplDetail* detail, float d2,
                       const Vec3& direction) {
    if (vpls.peak_density.empty()) return {};
    const float density = vpls.peak_density[std::size_t(&vpl - vpls.lights.data())];
    const auto spread = [&](const Vec3& w, float distance_squared) {
        return std::fabs(glm::dot(vpl.normal, w)) / distance_squared;
    };
    PeakLimits limits;
    limits.at_receiver = density / spread(direction, d2) + vpls.peak_directions;
    if (detail)
        limits.at_light = density / (spread(detail->vertex.wo, sqr(max_of(detail->vertex.hit.t, 1e-15f))) +
                                     spread(direction, d2));
    return limits;
}

}  // namespace

LaneConnection lane_connection(const ReceiverLanes& x, int i, const VplSet& vpls,
                               const VirtualPointLight& vpl, float light_weight) {
    const ScatteringVertex* receiver = x.directional[i];
    const VplDetail* detail =
        vpl.detail == VirtualPointLight::no_detail ? nullptr : &vpls.details[vpl.detail];
    const Vec3 from = receiver ? receiver->position : Vec3(x.x[i], x.y[i], x.z[i]);
    const Vec3 to = detail ? detail->vertex.position : vpl.position;
    const float d2 = max_of(glm::dot(to - from, to - from), min_distance_squared);
    const Vec3 direction = (to - from) / std::sqrt(d2);

    const PeakLimits limits = peak_limits(vpls, vpl, detail, d2, direction);
    LaneConnection c{Rgb(x.weight_r[i], x.weight_g[i], x.weight_b[i]), d2, 1.0f, 1.0f, from, to};
    if (receiver) {
        c.value *= receiver->eval(direction, TransportMode::radiance, limits.at_receiver);
        c.cos_x = receiver->shading_cosine(direction);
        c.origin = receiver->ray_origin(direction);
    } else if (x.in_medium[i] == 0.0f) {
        const Vec3 ns(x.shading_x[i], x.shading_y[i], x.shading_z[i]);
        const Vec3 ng(x.geometric_x[i], x.geometric_y[i], x.geometric_z[i]);
        c.cos_x = glm::dot(ng, direction) > 0.0f ? max_of(0.0f, glm::dot(ns, direction)) : 0.0f;
    }
    c.value *= vpl.intensity * light_weight;
    if (detail) {
        c.value *= detail->eval(-direction, limits.at_light);  // I_j of Eq. 10.3 towards this receiver
        c.cos_y = detail->vertex.geometric_cosine(direction);
        c.target = detail->vertex.ray_origin(-direction);
    } else if (vpl.on_surface()) {
        c.cos_y = glm::dot(vpl.shading_normal, direction) < 0.0f
                      ? max_of(0.0f, -glm::dot(vpl.normal, direction))
                      : 0.0f;
    }
    return c;
}

}  // namespace mote::lights
