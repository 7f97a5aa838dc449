// Gathering and shadow maps on a scene that is not ours: RayQueries answered by formulas.
#include "tests/support/analytic_scene.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using tests::AnalyticScene, tests::FloorUnderLight;

namespace {
const Rgb fog(0.3f, 0.6f, 1.2f);

// Shares of the unshadowed light. By rays: rounding of some twenty operations in single precision.
constexpr float rounding = 20.0f * 6e-8f;
// By maps: depth h / cos(a) is interpolated linearly between rays that are w apart, which is off by at most
// w^2 / 8 times its second derivative, twice for two dimensions. h = 1.2 (blue), a <= 42 degrees, where
// the second derivative of 1 / cos is (1 + 2 tan^2 a) / cos a < 3.5; w < 2.4 / size for an octahedral map.
// What is stored of depth is off by half a unit.
constexpr float map_tolerance(float size) {
    return 1.2f * 3.5f * 2.0f / 8.0f * (2.4f / size) * (2.4f / size) +
           0.5f * lights::VolumetricShadowMap::depth_unit + rounding;
}
constexpr int size = 256;  // no receiver lies within a texel of the edge of the shadow
}  // namespace

TEST_CASE("gathering by rays queries another scene and finds the closed form", "[gather][interface]") {
    const AnalyticScene scene(fog);
    FloorUnderLight at(scene);
    const auto found = tests::traced_light(scene, at);
    int dark = 0;
    for (const Rgb& light : found) dark += is_black(light);
    CHECK(dark > 0);
    CHECK(dark < lights::ReceiverLanes::width);
    CHECK(FloorUnderLight::largest_error(scene, found) < rounding);
    CHECK(scene.transmittances == lights::ReceiverLanes::width - dark);
    // A closed form without the ball, or with other fog, is distinguished.
    CHECK(FloorUnderLight::largest_error(scene, found, false) > 100.0f * rounding);
    CHECK(FloorUnderLight::largest_error(AnalyticScene(1.01f * fog), found) > 100.0f * rounding);
}

TEST_CASE("transmittance is not requested where nothing attenuates", "[gather][interface]") {
    const AnalyticScene scene(Rgb(0.0f));
    FloorUnderLight at(scene);
    CHECK(FloorUnderLight::largest_error(scene, tests::traced_light(scene, at)) < rounding);
    CHECK(scene.transmittances == 0);
}

TEST_CASE("shadow maps of another scene hold its closed form", "[shadow_map][interface]") {
    const AnalyticScene scene(fog);
    FloorUnderLight at(scene);
    const auto found = tests::mapped_light(scene, at, size);
    CHECK(scene.transmittances == 0);  // marched
    CHECK(FloorUnderLight::largest_error(scene, found) < map_tolerance(size));
    CHECK(FloorUnderLight::largest_error(scene, found, false) > 10.0f * map_tolerance(size));
    CHECK(FloorUnderLight::largest_error(AnalyticScene(1.05f * fog), found) > map_tolerance(size));
}
