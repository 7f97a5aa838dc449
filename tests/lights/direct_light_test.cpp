// Direct light at a vertex, by both techniques and their weights: two lamps of different power, so that the
// chance of each light is part of the weights. Light sampling alone, directions alone and both together are
// one closed form.
#include "lights/direct_light/direct_light.h"
#include "tests/lights/emitter_statistics.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;
using namespace mote::core;

namespace {

/// A floor, a large disc of 2 W/(m^2 sr) one metre above the origin, and behind it, five metres up, one that
/// is far brighter; the middle of the near one hides nothing of the far one for a receiver at the origin.
std::unique_ptr<Scene> two_lamps() {
    return scene_from(R"(<scene version="3.0.0">
        <shape type="rectangle"><transform name="to_world"><scale value="20"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.8"/></bsdf></shape>
        <shape type="disk"><transform name="to_world"><rotate x="1" angle="180"/><translate z="1"/></transform>
            <emitter type="area"><rgb name="radiance" value="2"/></emitter></shape>
        <shape type="disk"><transform name="to_world"><scale value="0.5"/><rotate y="1" angle="-90"/>
            <translate x="5" z="3"/></transform>
            <emitter type="area"><rgb name="radiance" value="60"/></emitter></shape>
        <sensor type="perspective"/></scene>)");
}

/// Direct light at the origin: of discs parallel to the floor R^2 / (R^2 + h^2) of pi L, of the far one by
/// quadrature.
double closed_form() {
    const double near = 2.0 * 0.5;
    constexpr int n = 400;
    double far = 0.0;
    for (int i = 0; i < n * n; ++i) {
        const double r = 0.5 * std::sqrt((i / n + 0.5) / n), phi = 2.0 * double(pi) * (i % n + 0.5) / n;
        const Vec3d y(5.0, r * std::cos(phi), 3.0 + r * std::sin(phi));
        const double d2 = glm::dot(y, y), d = std::sqrt(d2);
        far += (y.z / d) * (y.x / d) / d2;
    }
    far *= 60.0 * 0.25 * double(pi) / (n * n) / double(pi);
    return 0.8 * (near + far);
}

ScatteringVertex floor_at_origin(const Scene& scene) {
    const Ray ray{Vec3(0, 0, 0.5f), Vec3(0, 0, -1)};
    WalkEvent event;
    event.kind = WalkEvent::Kind::surface, event.hit = *scene.first_hit(ray);
    return make_vertex(event, ray);
}

struct Techniques {
    Mean light, directions, both;
};

Techniques estimate(const Scene& scene, int samples) {
    const ScatteringVertex vertex = floor_at_origin(scene);
    WalkContext context;
    context.rng = Rng(11);
    Techniques t;
    for (int i = 0; i < samples; ++i) {
        const MediumState state;
        const PathWeights weights;
        const float u = context.rng.next_float();
        const Vec2 u_light = context.rng.next_vec2(), u_lobe = context.rng.next_vec2();
        const double light =
            double(mote::lights::sample_light<false>(scene, vertex, weights, state, u, u_light, context).x);
        const auto s = vertex.sample(context.rng.next_float(), u_lobe, TransportMode::radiance);
        const double found =
            s ? double(mote::lights::light_towards<false>(scene, vertex, *s, weights, state, context).x)
              : 0.0;
        t.light.add(light), t.directions.add(found), t.both.add(light + found);
    }
    return t;
}

}  // namespace

TEST_CASE("two lamps of unlike power, by light sampling and by directions, add up to the closed form",
          "[lights][direct_light]") {
    const auto scene = two_lamps();
    const double expected = closed_form();
    const Techniques t = estimate(*scene, 200000);
    INFO("light sampling " << t.light.value() << " and directions " << t.directions.value() << ": "
                           << t.both.value() << " +- " << t.both.error() << " against " << expected);
    CHECK(agree(t.both, expected));
    // Either has a good part of the sum: its weight is not nothing, and an error of 3 % in one would be seen.
    CHECK(t.light.value() > 0.1 * expected);
    CHECK(t.directions.value() > 0.1 * expected);
    CHECK(sigmas * t.both.error() < 0.03 * std::min(t.light.value(), t.directions.value()));
}
