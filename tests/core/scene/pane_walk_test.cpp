// A path passes a pane by chance. What a walk leaves in its weights: the pane's own tint in the throughput,
// and the chance where light sampling, which passes for certain, is weighted against it.
#include "core/scene/ray_walk.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

TEST_CASE("a walk through panes carries their tint and the chance to pass them", "[scene][panes]") {
    const auto scene = load_body(
        "<shape type='rectangle'><bsdf type='thindielectric'><float name='int_ior' value='1.5'/>"
        "<float name='ext_ior' value='1'/><rgb name='specular_transmittance' value='0.5, 0.6, "
        "0.7'/></bsdf></shape>"
        "<shape type='rectangle'><transform name='to_world'><translate z='-1'/></transform>"
        "<bsdf type='thindielectric'><float name='int_ior' value='1.5'/><float name='ext_ior' "
        "value='1'/></bsdf>"
        "</shape>");
    // One face reflects R = (0.5 / 2.5)^2, a pane 2 R / (1 + R) with all orders.
    const double face = 0.04, passes = 1.0 - 2.0 * face / (1.0 + face);
    WalkContext context;
    context.rng = Rng(3);
    int escaped = 0;
    constexpr int walks = 20000;
    for (int i = 0; i < walks; ++i) {
        PathWeights weights;
        weights.light = Rgb(1.0f);  // as after a scattering of density 1
        MediumState state;
        Rgb emitted(0.0f);
        const WalkEvent event =
            walk<false>(*scene, Ray{Vec3(0.1f, 0.2f, 2), Vec3(0, 0, -1)}, state, weights, emitted, context);
        if (event.kind != WalkEvent::Kind::escaped) {
            REQUIRE(event.reflected);
            continue;
        }
        ++escaped;
        REQUIRE(weights.throughput.x == Approx(0.5));
        REQUIRE(weights.throughput.z == Approx(0.7));
        for (int c = 0; c < 3; ++c) REQUIRE(weights.light[c] == Approx(1.0 / (passes * passes)));
    }
    const double chance = passes * passes;
    CHECK(std::fabs(double(escaped) / walks - chance) < 4.5 * std::sqrt(chance * (1.0 - chance) / walks));
}
