#include "compensation/light_compensation.h"

#include "lights/direct_light/direct_light.h"

namespace mote::compensation {

using namespace core;

namespace {

/// L of Eq. 10.11 from the primary lights, L_S^d and L_M^d below Eq. 10.7 of Engelhardt 2013: at a vertex by
/// light sampling and by the directions in which it scatters.
template <bool Media>
Rgb direct_light(const LitScene& scene, const ResidualPath& path, WalkContext& context) {
    const float u_light = context.rng.next_float();
    const Vec2 u = context.rng.next_vec2();
    Rgb sum = lights::sample_light<Media>(scene, path.vertex, path.weights, path.state, u_light, u, context);
    const float u_lobe = context.rng.next_float();
    const auto next = path.vertex.sample(u_lobe, context.rng.next_vec2(), TransportMode::radiance);
    if (!next) return sum;
    return sum + lights::light_towards<Media>(scene, path.vertex, *next, path.weights, path.state, context);
}

}  // namespace

template <bool Media>
Rgb compensation_from_lights(const LitScene& scene, const ResidualTransport& transport, ResidualPath path,
                             int steps, WalkContext& context, std::uint64_t& vertices) {
    Rgb sum(0.0f);
    // One term L_r of Eq. 10.12 after the other: the recursion ends where B* is 0 (Sec. 10.1.3, step 2).
    for (int i = 0; (steps < 0 || i < steps) && transport.step<Media>(path, context); ++i) {
        sum += direct_light<Media>(scene, path, context);
        ++vertices;
    }
    return sum;
}

template Rgb compensation_from_lights<true>(const LitScene&, const ResidualTransport&, ResidualPath, int,
                                            WalkContext&, std::uint64_t&);
template Rgb compensation_from_lights<false>(const LitScene&, const ResidualTransport&, ResidualPath, int,
                                             WalkContext&, std::uint64_t&);

}  // namespace mote::compensation
