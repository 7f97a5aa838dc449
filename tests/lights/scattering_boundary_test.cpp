// Receivers on a boundary that scatters: a ball of ground glass with fog inside. Which medium a connection
// goes through depends on the side that it leaves to. Gathering against a plain sum whose fog is a length
// inside a ball.
#include <cmath>

#include "core/math/warp.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"
#include "tests/lights/closed_box.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

constexpr float ball_radius = 0.5f;
const Rgb sigma_t(3.0f, 2.0f, 1.0f);

const std::string ball = R"(<shape type="sphere"><float name="radius" value="0.5"/>
    <bsdf type="roughdielectric"><float name="alpha" value="0.5"/></bsdf><medium type="homogeneous" name="interior">
    <rgb name="sigma_t" value="3, 2, 1"/><rgb name="albedo" value="0.9"/></medium></shape>)";

/// A tile of receivers on the ball: eight seen from outside, eight from its middle.
struct Receivers {
    lights::ReceiverTile tile;
    std::vector<ScatteringVertex> vertices{std::size_t(lights::ReceiverTile::width)};

    explicit Receivers(const Scene& scene) {
        Rng rng(3);
        for (int i = 0; i < lights::ReceiverTile::width; ++i) {
            const Vec3 d = square_to_sphere(rng.next_vec2());
            const bool outside = i % 2 == 0;
            const Ray ray{outside ? -0.9f * d : Vec3(0.0f), d, 0.0f, infinity};
            const auto hit = scene.first_hit(ray);
            ScatteringVertex& v = vertices[std::size_t(i)];
            v.position = hit->position, v.hit = *hit, v.bsdf = hit->shape->bsdf.get(), v.wo = -d;
            tile.set(i, v, Rgb(1.0f), scene.medium_state_at(ray.origin, nullptr), rng, 1000);
        }
    }
};

/// Nothing but the ball lies between points within the box, so a segment is inside of it or outside, all of
/// it.
Rgb transmittance(const Vec3& a, const Vec3& b) {
    const bool inside = glm::length(0.5f * (a + b)) < ball_radius;
    return inside ? glm::exp(-sigma_t * glm::distance(a, b)) : Rgb(1.0f);
}

/// The sum of Eqs. 10.4 and 10.5 without a bound (Engelhardt 2013), one lane.
Rgb plain_sum(const Scene& scene, const lights::VplSet& vpls, const Receivers& receivers, int lane) {
    glm::dvec3 sum(0.0);
    const ScatteringVertex& v = receivers.vertices[std::size_t(lane)];
    for (const auto& vpl : vpls.lights) {
        const lights::LaneConnection c = lights::lane_connection(receivers.tile, lane, vpls, vpl, 1.0f);
        const Vec3 way = c.target - c.origin;
        const float distance = glm::length(way);
        if (is_black(c.value) ||
            scene.rays().occluded({v.ray_origin(way), way / distance, 0.0f, 0.9999f * distance}))
            continue;
        sum += glm::dvec3(c.value * (c.cos_x * c.cos_y / c.distance_squared) *
                          transmittance(c.origin, c.target));
    }
    return Rgb(sum);
}

}  // namespace

TEST_CASE("receivers on ground glass see through the fog on the side of each light", "[vpl][gather][media]") {
    const auto scene = scene_from(closed_box(diffuse, ball));
    lights::LightPathSettings paths;
    paths.paths = 256;
    const auto vpls = lights::trace_light_paths(*scene, paths, 7, 0, SamplerKind::independent);
    Receivers receivers(*scene);
    lights::GatherScratch scratch;
    RayCounters rays;
    TrackingCounters tracking;
    const auto light = lights::gather({*scene, scratch, rays, tracking}, vpls, lights::VplRange{},
                                      lights::BoundedGeometry{infinity}, receivers.tile);
    for (int i = 0; i < lights::ReceiverTile::width; ++i) {
        const Rgb expected = plain_sum(*scene, vpls, receivers, i);
        INFO("receiver " << i);
        REQUIRE(expected.x > 0.0f);
        for (int c = 0; c < 3; ++c) CHECK(light[std::size_t(i)][c] == Approx(expected[c]).epsilon(1e-3));
    }
}

TEST_CASE("light paths that enter a ball of ground glass meet the fog there, and only there",
          "[vpl][particles][media]") {
    const auto scene = scene_from(closed_box(diffuse, ball));
    lights::LightPathSettings paths;
    paths.paths = 2000, paths.max_vertices = 3;
    const auto vpls = lights::trace_light_paths(*scene, paths, 8, 0, SamplerKind::independent);
    int in_fog = 0;
    for (std::size_t i = 0; i < vpls.lights.size(); ++i) {
        if (vpls.lights[i].on_surface()) continue;
        CHECK(glm::length(vpls.lights[i].position) < ball_radius);
        CHECK(vpls.states[i].current() == scene->media().front().get());
        ++in_fog;
    }
    CHECK(in_fog > 100);
}
