// Ray lights and lines in media that scatter forward: every phase function's angle is the one between the way
// of the light and the way on, which isotropic media do not distinguish from its opposite.
#include "core/scene/scene.h"
#include "lights/ray_lights/line_connections.h"
#include "lights/ray_lights/line_importance.h"
#include "media/homogeneous_medium.h"
#include "media/phase_functions.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::lights;

namespace {

constexpr double g = 0.7;

/// Henyey and Greenstein 1941 [1/sr].
double phase_at(double cosine) {
    return (1.0 - g * g) / (4.0 * double(pi) * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

const media::HomogeneousMedium forward(Rgb(1.0f), Rgb(1.0f), Rgb(0.0f),
                                       std::make_shared<media::HenyeyGreensteinPhase>(float(g)));

/// Scatters forward and takes nothing: short, so that an angle is one angle.
MediumLine short_line(const Vec3& origin, const Vec3& direction, float length = 0.01f) {
    MediumLine line;
    line.origin = origin, line.direction = glm::normalize(direction), line.length = length;
    line.medium = &forward, line.homogeneous = true, line.isotropic = false;
    line.sigma_s = Rgb(1.0f), line.weights[0] = 1.0f;
    return line;
}

Vec3 around_x(double angle, double distance) {
    return Vec3(Vec3d(std::cos(angle), std::sin(angle), 0.0) * distance);
}

constexpr double angles[] = {0.1, 0.8, 1.5, 2.2, 3.0};

}  // namespace

TEST_CASE("a ray light scatters forward to a point", "[ray_lights][directions]") {
    Rng rng(1);
    TrackingCounters counters;
    RayLight light;
    light.line = short_line({-0.005f, 0, 0}, {1, 0, 0}), light.power = Rgb(1.0f);
    for (const double angle : angles) {
        ReceiverLanes lanes;
        const Vec3 x = around_x(angle, 2.0);
        lanes.x[3] = x.x, lanes.y[3] = x.y, lanes.z[3] = x.z, lanes.in_medium[3] = 1.0f;
        lanes.weight_r[3] = lanes.weight_g[3] = lanes.weight_b[3] = 1.0f, lanes.max_vpl_depth[3] = 10;
        const auto c = connect(lanes, 3, light, 0.5f, infinity, {rng, counters});
        REQUIRE(c);
        CHECK(double(c->value.x) == Approx(0.01 * phase_at(std::cos(angle)) / 4.0).epsilon(0.01));
    }
}

TEST_CASE("light of a surface is scattered forward along an eye ray", "[ray_lights][directions]") {
    Rng rng(1);
    TrackingCounters counters;
    EyeLine eye;
    eye.line = short_line({-0.005f, 0, 0}, {1, 0, 0}), eye.throughput = Rgb(1.0f), eye.max_depth = 10;
    for (const double angle : angles) {
        VplSet vpls;
        VirtualPointLight& vpl = vpls.lights.emplace_back();
        vpl.position = around_x(angle, 2.0), vpl.intensity = Rgb(1.0f);
        vpl.normal = vpl.shading_normal = -glm::normalize(vpl.position);
        const auto c = connect(eye, vpls, vpl, 0.5f, {rng, counters});
        REQUIRE(c);
        // A light straight ahead of the eye shines into it: its way hardly bends.
        CHECK(double(c->value.x) == Approx(0.01 * phase_at(std::cos(angle)) / 4.0).epsilon(0.01));
    }
}

TEST_CASE("both phase functions of a ray light and an eye ray see their own angle",
          "[ray_lights][directions]") {
    Rng rng(1);
    TrackingCounters counters;
    for (const double angle : angles)
        for (const double own : angles) {
            RayLight light;  // 2 m away along the angle, leaving at `own` to the way back to the eye ray
            const Vec3 at = around_x(angle, 2.0), back = -glm::normalize(at);
            const Vec3 way(Vec3d(back) * std::cos(own) + Vec3d(0, 0, 1) * std::sin(own));
            light.line = short_line(at - 0.005f * way, way), light.power = Rgb(1.0f);
            EyeLine eye;
            eye.line = short_line({-0.005f, 0, 0}, {1, 0, 0});
            eye.throughput = Rgb(1.0f), eye.max_depth = 10;
            const auto c = connect(eye, light, {0.5f, 0.5f}, {rng, counters});
            REQUIRE(c);
            const double exact = 1e-4 * phase_at(std::cos(angle)) * phase_at(std::cos(own)) / 4.0;
            CHECK(double(c->value.x) == Approx(exact).epsilon(0.02));
        }
}

TEST_CASE("the importance of ray lights follows where media scatter to", "[ray_lights][directions]") {
    // The way along the light, and along the eye ray, towards the other one and away from it.
    const auto expected = [](const Vec3& way_of_light, const Vec3& way_of_eye) {
        RayLight light;
        light.line = short_line({0, 0, 0}, way_of_light), light.power = Rgb(1.0f);
        EyeLine eye;
        eye.line = short_line({2, 0, 0}, way_of_eye), eye.throughput = Rgb(1.0f), eye.max_depth = 10;
        EyeLines eyes;
        eyes.of[2] = &eye;
        core::Lanes found;
        importance(light, EyeReceivers(eyes), found);
        return double(found[2]);
    };
    const double least = expected({-1, 0.1f, 0}, {1, 0.1f, 0});
    CHECK(expected({1, 0.1f, 0}, {1, 0.1f, 0}) > 10.0 * least);
    CHECK(expected({-1, 0.1f, 0}, {-1, 0.1f, 0}) > 10.0 * least);
    CHECK(expected({1, 0.1f, 0}, {-1, 0.1f, 0}) > 100.0 * least);
    CHECK(least > 0.0);
}
