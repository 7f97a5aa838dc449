// The weights of virtual point lights and of bundles, whose paths continue, add up to 1 for every path that
// they can make.
#include "gathering/eye_bundles/path_weights.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "tests/gathering/eye_bundle_rooms.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

namespace {

constexpr TechniqueSamples samples{
    .directions = 5, .paths = 300, .light_probability = 0.25f, .joined_probability = 0.1f, .continued = 0.3f};

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

struct Traced {
    const Scene& scene;
    const lights::VplSet& vpls;
    const TechniqueSamples& samples;
    std::span<const float> rivals;
};

/// P(x -> y).
float found_density(const ScatteringVertex& x, const ScatteringVertex& y) {
    const Vec3 to_y = y.position - x.position;
    const float d2 = glm::dot(to_y, to_y);
    return uniform_line_pdf * y.geometric_cosine(to_y / std::sqrt(d2)) / d2;
}

/// The weight of the light that y connects.
double weight_connected(const Traced& t, std::size_t j, const ScatteringVertex& y, const FewerFound& fewer) {
    const auto end = connected(t.scene, y, t.vpls.starts[t.vpls.lights[j].path]);
    const EmitterTraits traits = end.emitter->traits();
    const Vec3 towards =
        traits.infinite || traits.delta_direction ? -end.direction : glm::normalize(end.origin - y.position);
    return double(connection_weight(
        t.samples, fewer.from(y, towards),
        connection_over_emission(t.scene, y.light_receiver(), y.hit.geometric_normal, end)));
}

/// The weight of VPL j joined to y.
double weight_joined(const Traced& t, std::size_t j, const ScatteringVertex& y, const FewerFound& fewer) {
    lights::ReceiverTile tile;
    tile.set(0, y, Rgb(1.0f), {}, Rng(1), 100);
    const auto& z = t.vpls.lights[j];
    const Vec3 at_y(tile.x[0], tile.y[0], tile.z[0]), to_z = z.position - at_y;
    const float dz2 = glm::dot(to_z, to_z), cos_y = y.shading_cosine(to_z / std::sqrt(dz2));
    const float g = cos_y * std::fabs(glm::dot(z.normal, to_z)) / (dz2 * std::sqrt(dz2));
    const AgainstLights policy{&fewer, t.rivals, t.samples};
    return double(policy.for_pair(tile, t.vpls, j)(g, dz2, cos_y, 0.0f, 0) / g);
}

/// Sum of the weights of all techniques that find the last vertices of the path of VPL j by bundles, from x
/// on: the last of them connects the light. Empty where a ray hits something else on its way.
std::optional<double> weights_of_bundles(const Traced& t, std::size_t j, const ScatteringVertex& x) {
    double sum = 0.0;
    ScatteringVertex last = x;
    FewerFound fewer;
    for (std::size_t v = j;; --v) {
        const auto y = found_from(t.scene, last, t.vpls.lights[v].position);
        if (!y) return std::nullopt;
        fewer = v == j ? fewer_than_one(t.samples, found_density(x, *y))
                       : fewer_than_next(t.samples, last, fewer, *y);
        if (t.vpls.lights[v].depth == 1) return sum + weight_connected(t, v, *y, fewer);
        sum += weight_joined(t, v - 1, *y, fewer);
        if (t.samples.continued == 0.0f) return sum;
        last = *y;
    }
}

/// Are two points that follow each other on the path of VPL j close, or do they see each other along a
/// surface? There rounding of a position, some 1e-7 of the room, is a larger part of a distance or a cosine.
bool ill_conditioned(const lights::VplSet& vpls, std::size_t j, const Vec3& x) {
    const auto grazing = [](const Vec3& n, const Vec3& to) {
        return std::fabs(glm::dot(n, glm::normalize(to))) < 0.2f;
    };
    Vec3 next = x;
    for (std::size_t v = j;; --v) {
        const auto& y = vpls.lights[v];
        if (glm::distance(next, y.position) < 0.2f || grazing(y.normal, next - y.position)) return true;
        const bool first = y.depth == 1;
        const auto& start = vpls.starts[y.path];
        const Vec3 z = first ? start.origin : vpls.lights[v - 1].position;
        const Vec3 normal = first ? start.normal : vpls.lights[v - 1].normal;
        if (glm::distance(y.position, z) < 0.2f) return true;
        if (!first && grazing(y.normal, z - y.position)) return true;
        if (normal != Vec3(0.0f) && grazing(normal, y.position - z)) return true;
        if (first) return false;
        next = y.position;
    }
}

struct Sums {
    int paths = 0, two_bounces = 0, three_bounces = 0;
    double worst = 0.0, least = 1.0, most = 0.0;
};

/// `planted`: what VPLs take for the chance to continue, over the true one.
Sums weights_of_paths(const std::string& bsdf, const std::string& light, float continued, float planted = 1) {
    const auto scene = scene_from(corner_room(bsdf, light));
    const lights::LightPathSettings settings{
        .paths = 1000, .max_vertices = 4, .rr_depth = 2, .keep_starts = true};
    const auto vpls = lights::trace_light_paths(*scene, settings, 3, 0, SamplerKind::independent);
    TechniqueSamples right = samples, wrong = samples;
    right.continued = continued, wrong.continued = planted * continued;
    const auto rivals = rivals_of(*scene, vpls, wrong);
    Rng rng(9);
    Sums sums;
    for (std::size_t j = 0; j < vpls.lights.size(); ++j) {
        const ScatteringVertex x = receiver(*scene, rng);
        if (!(rivals[j] > 0.0f) || ill_conditioned(vpls, j, x.position)) continue;
        const auto others = weights_of_bundles({*scene, vpls, right, rivals}, j, x);
        if (!others) continue;
        const double first = vpl_weight({rivals}, vpls, j, x.position);
        sums.worst = std::max(sums.worst, std::fabs(first + *others - 1.0));
        sums.least = std::min(sums.least, first), sums.most = std::max(sums.most, first);
        ++sums.paths, sums.two_bounces += vpls.lights[j].depth == 2,
            sums.three_bounces += vpls.lights[j].depth > 2;
    }
    return sums;
}

}  // namespace

// To rounding: techniques find the points by rays of their own.
TEST_CASE("weights of virtual point lights and of bundles add up to 1", "[bundles]") {
    const auto [bsdf, light] =
        GENERATE(table<std::string, std::string>({{matt, point_by_the_wall},
                                                  {matt, lamp},
                                                  {matt, ball_lamp},
                                                  {matt, sky},
                                                  {matt, sun},
                                                  {shiny, lamp},
                                                  {shiny, lamp + sky + point_by_the_wall}}));
    const float continued = GENERATE(0.0f, 0.3f);
    const Sums sums = weights_of_paths(bsdf, light, continued);
    CAPTURE(light, continued, sums.paths, sums.two_bounces, sums.three_bounces, sums.least, sums.most);
    CHECK(sums.paths > 100);
    CHECK(sums.two_bounces > 20);
    CHECK(sums.three_bounces > 0);
    CHECK(sums.most - sums.least > 0.1);  // neither technique has it all
    CHECK(sums.worst < 2e-6);
}

TEST_CASE("a VPL that takes paths to continue more often than they do is found", "[bundles][planted]") {
    CHECK(weights_of_paths(matt, point_by_the_wall, 0.3f).worst < 2e-6);
    CHECK(weights_of_paths(matt, point_by_the_wall, 0.3f, 1.1f).worst > 1e-4);
}
