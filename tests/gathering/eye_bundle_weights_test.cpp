// The weights of virtual point lights and of bundles add up to 1 for every path that both can make.
#include "gathering/eye_bundles/path_weights.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "tests/gathering/eye_bundle_rooms.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

namespace {

constexpr TechniqueSamples samples{.directions = 5, .paths = 300, .light_share = 0.25f, .joined_share = 0.1f};

/// A point on the floor or a wall, seen from inside the room.
ScatteringVertex receiver(const Scene& scene, Rng& rng) {
    const Vec3 eye(-0.9f, 0.9f, 0.95f);
    Vec3 target(1.8f * rng.next_float() - 0.9f, 1.8f * rng.next_float() - 0.9f,
                1.8f * rng.next_float() - 0.9f);
    const int wall = int(3.0f * rng.next_float());
    target[wall] = wall == 0 ? 1.0f : -1.0f;
    return vertex_on(scene, eye, target - eye);
}

/// The weight that the gather gives to a VPL at a distance: the policy's result over G*.
double vpl_weight(const AgainstBundles& policy, const lights::VplSet& vpls, std::size_t j, const Vec3& x) {
    const lights::ReceiverLanes none;
    const Vec3 to_x = x - vpls.lights[j].position;
    const float d2 = glm::dot(to_x, to_x);
    const float cos_y = std::fabs(glm::dot(vpls.lights[j].normal, to_x)) / std::sqrt(d2);
    return double(policy.for_pair(none, vpls, j)(1.0f, d2, 1.0f, cos_y));
}

/// y as a ray of a bundle finds it, from x; nothing where something else is in the way.
std::optional<ScatteringVertex> found_from(const Scene& scene, const ScatteringVertex& x, const Vec3& y) {
    const Vec3 w = glm::normalize(y - x.position);
    const Ray ray{x.ray_origin(w), w};
    const auto hit = scene.first_hit(ray);
    if (!hit || glm::distance(hit->position, y) > 1e-4f) return std::nullopt;
    return vertex_on(scene, ray.origin, w);
}

/// The end of the light path as next-event estimation at y finds it.
lights::LightStart connected(const Scene& scene, const ScatteringVertex& y, const lights::LightStart& start) {
    const EmitterTraits traits = start.emitter->traits();
    if (!traits.can_be_hit() || traits.infinite) return start;
    const Vec3 w = glm::normalize(start.origin - y.position);
    const auto hit = scene.first_hit({y.ray_origin(w), w});
    REQUIRE(hit);
    return {start.emitter, hit->position, hit->geometric_normal, -w};
}

/// w_2 as a bundle finds it at y.
double bundle_weight(const Scene& scene, const lights::VplSet& vpls, std::size_t j, const ScatteringVertex& x,
                     const ScatteringVertex& y) {
    const Vec3 to_y = y.position - x.position;
    const float d2 = glm::dot(to_y, to_y);
    const float found = uniform_line_pdf * y.geometric_cosine(to_y / std::sqrt(d2)) / d2;
    const auto& light = vpls.lights[j];
    if (light.depth == 1)
        return double(
            one_bounce_weight(samples, found,
                              connection_over_emission(scene, y.light_receiver(), y.hit.geometric_normal,
                                                       connected(scene, y, vpls.starts[light.path]))));
    lights::ReceiverTile tile;
    tile.set(0, y, Rgb(1.0f), {}, Rng(1), 100);
    alignas(64) const float density[16] = {samples.directions * samples.joined_share * found};
    const auto& z = vpls.lights[j - 1];
    const Vec3 at_y(tile.x[0], tile.y[0], tile.z[0]), to_z = z.position - at_y;
    const float dz2 = glm::dot(to_z, to_z), cos_y = y.shading_cosine(to_z / std::sqrt(dz2));
    const float g = cos_y * std::fabs(glm::dot(z.normal, to_z)) / (dz2 * std::sqrt(dz2));
    const AgainstLights policy{density, samples.light_share};
    return double(policy.for_pair(tile, vpls, j - 1)(g, dz2, cos_y, 0.0f, 0) / g);
}

/// Are two of the three points close, or do they see each other along a surface? There rounding of a
/// position, some 1e-7 of the room, is a larger part of a distance or a cosine.
bool ill_conditioned(const lights::VplSet& vpls, std::size_t j, const Vec3& x) {
    const auto& y = vpls.lights[j];
    const bool first = y.depth == 1;
    const Vec3 z = first ? vpls.starts[y.path].origin : vpls.lights[j - 1].position;
    const Vec3 normal = first ? vpls.starts[y.path].normal : vpls.lights[j - 1].normal;
    const auto grazing = [](const Vec3& n, const Vec3& to) {
        return std::fabs(glm::dot(n, glm::normalize(to))) < 0.2f;
    };
    return glm::distance(x, y.position) < 0.2f || glm::distance(y.position, z) < 0.2f ||
           grazing(y.normal, x - y.position) || (normal != Vec3(0.0f) && grazing(normal, y.position - z));
}

struct Sums {
    int paths = 0, two_bounces = 0;
    double worst = 0.0, least = 1.0, most = 0.0;
};

Sums weights_of_paths(const std::string& bsdf, const std::string& light) {
    const auto scene = scene_from(corner_room(bsdf, light));
    const lights::LightPathSettings settings{
        .paths = 1000, .max_vertices = 4, .rr_depth = 2, .keep_starts = true};
    const auto vpls = lights::trace_light_paths(*scene, settings, 3, 0, SamplerKind::independent);
    const auto rivals = rivals_of(*scene, vpls, samples);
    Rng rng(9);
    Sums sums;
    for (std::size_t j = 0; j < vpls.lights.size(); ++j) {
        const ScatteringVertex x = receiver(*scene, rng);
        const auto y = found_from(*scene, x, vpls.lights[j].position);
        if (!y || !(rivals[j] > 0.0f) || ill_conditioned(vpls, j, x.position)) continue;
        const double first = vpl_weight({rivals}, vpls, j, x.position);
        const double second = bundle_weight(*scene, vpls, j, x, *y);
        sums.worst = std::max(sums.worst, std::fabs(first + second - 1.0));
        sums.least = std::min(sums.least, first), sums.most = std::max(sums.most, first);
        ++sums.paths, sums.two_bounces += vpls.lights[j].depth > 1;
    }
    return sums;
}

}  // namespace

// To rounding: both techniques find the points by rays of their own.
TEST_CASE("weights of virtual point lights and of bundles add up to 1", "[bundles]") {
    const auto [bsdf, light] =
        GENERATE(table<std::string, std::string>({{matt, point_by_the_wall},
                                                  {matt, lamp},
                                                  {matt, ball_lamp},
                                                  {matt, sky},
                                                  {matt, sun},
                                                  {shiny, lamp},
                                                  {shiny, lamp + sky + point_by_the_wall}}));
    const Sums sums = weights_of_paths(bsdf, light);
    CAPTURE(light, sums.paths, sums.two_bounces, sums.least, sums.most);
    CHECK(sums.paths > 100);
    CHECK(sums.two_bounces > 20);
    CHECK(sums.most - sums.least > 0.1);  // neither technique has it all
    CHECK(sums.worst < 1e-6);
}
