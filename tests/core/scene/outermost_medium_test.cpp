// The medium around everything: who may name it, who agrees, and where eye rays begin.
#include "core/scene/medium_state.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// Media a, b with extinction 1, 2 in the first two lines, and then `body`.
std::unique_ptr<Scene> scene_with(const std::string& body) {
    return load_body(
        "<medium type='homogeneous' id='a'><float name='sigma_t' value='1'/></medium>\n"
        "<medium type='homogeneous' id='b'><float name='sigma_t' value='2'/></medium>\n" +
        body);
}

const std::string sensor_in_a = "<sensor type='perspective'><ref id='a'/></sensor>\n";
const std::string light_in_a = "<emitter type='point'><ref id='a'/></emitter>\n";
const std::string light_in_b = "<emitter type='point'><ref id='b'/></emitter>\n";
std::string sphere(const std::string& x, const std::string& content) {
    return "<shape type='sphere'><point name='center' x='" + x + "' y='0' z='0'/>" + content + "</shape>\n";
}
const std::string out_a = "<ref name='exterior' id='a'/>", out_b = "<ref name='exterior' id='b'/>",
                  in_a = "<ref name='interior' id='a'/>", in_b = "<ref name='interior' id='b'/>",
                  null_bsdf = "<bsdf type='null'/>";

float sigma(const MediumState& state) {
    return state.current() ? dynamic_cast<const FakeMedium&>(*state.current()).sigma_t.x : 0.0f;
}

}  // namespace

TEST_CASE("One name is enough for all that lies outside", "[scene][media]") {
    const std::string lamp = "<emitter type='point'><point name='position' x='0' y='7' z='0'/></emitter>";
    for (const std::string& naming : {sensor_in_a, light_in_a, sphere("20", out_a),
                                      sphere("20", out_a + in_b + null_bsdf), sensor_in_a + light_in_a}) {
        const auto scene = scene_with(naming + lamp + sphere("5", in_b + null_bsdf));
        INFO(naming);
        REQUIRE(scene->outermost_medium());
        CHECK(sigma(scene->camera_medium_state()) == 1);
        CHECK(sigma(scene->medium_state_at({0, 3, 0}, nullptr)) == 1);
        CHECK(sigma(scene->medium_state_at({5, 0, 0}, nullptr)) == 2);
        const EmissionSample anywhere{};
        for (const auto& emitter : scene->emitters())
            CHECK(sigma(scene->emitter_medium_state(*emitter, anywhere)) == 1);
        // From the sphere one comes back into it.
        MediumState state = scene->medium_state_at({5, 0, 0}, nullptr);
        state.leave(*scene->shapes().back());
        CHECK(sigma(state) == 1);
    }
}

TEST_CASE("Who is inside of a shape says nothing about what is outside", "[scene][media]") {
    // The sensor stands in the sphere, and names what is there.
    CHECK_FALSE(scene_with(sensor_in_a + sphere("0", in_a + null_bsdf))->outermost_medium());
    CHECK_FALSE(scene_with(light_in_a + sphere("0", in_a + null_bsdf))->outermost_medium());
    // An opaque ball within the smoke names the smoke.
    const std::string ball = "<shape type='sphere'><float name='radius' value='.1'/>" + out_a + "</shape>";
    CHECK_FALSE(scene_with(ball + sphere("0", in_a + null_bsdf))->outermost_medium());
}

TEST_CASE("Two outermost media are an error that shows both lines", "[scene][media][input]") {
    // Media take two lines after the one that load_body() begins with; names follow on the next two.
    for (const auto& [first, second] :
         {std::pair(sensor_in_a, light_in_b), std::pair(sensor_in_a, sphere("5", out_b)),
          std::pair(light_in_a, sphere("5", out_b)), std::pair(sphere("5", out_a), sphere("9", out_b))}) {
        INFO(first << second);
        std::string message;
        try {
            scene_with(first + second);
        } catch (const InputError& error) {
            message = error.what();
        }
        CHECK(contains(message, "one outermost medium"));
        CHECK(contains(message, "medium 'a'"));
        CHECK(contains(message, "medium 'b'"));
        // Order of the names depends on the order of queries; both lines are in the text.
        CHECK(contains(message, ":4"));
        CHECK(contains(message, ":5"));
    }
    CHECK_NOTHROW(scene_with(sensor_in_a + light_in_a + sphere("5", out_a)));
}

TEST_CASE("Every eye ray begins in the medium of its own origin", "[scene][media]") {
    // A parallel projection, four wide, whose plane cuts the sphere of radius one: rays begin on either side.
    const auto parallel = scene_with(
        "<sensor type='orthographic'><transform name='to_world'><scale value='2'/></transform></sensor>" +
        sphere("0", in_a + null_bsdf));
    const auto size = Vec2(float(parallel->film().width), float(parallel->film().height));
    int inside = 0, outside = 0;
    for (float y = 0.05f; y < 1.0f; y += 0.1f)
        for (float x = 0.05f; x < 1.0f; x += 0.1f) {
            const Ray ray = parallel->camera().sample_ray(size * Vec2(x, y), Vec2(0.5f));
            const bool in = glm::length(ray.at(ray.t_min)) < 1.0f;
            ++(in ? inside : outside);
            REQUIRE(sigma(parallel->eye_medium_state(ray)) == (in ? 1.0f : 0.0f));
        }
    CHECK(inside > 10);
    CHECK(outside > 10);
    // A lens of radius two around a sphere of radius one.
    const auto lens =
        scene_with("<sensor type='thinlens'><float name='aperture_radius' value='2'/></sensor>" +
                   sphere("0", in_a + null_bsdf));
    inside = outside = 0;
    for (float u = 0.05f; u < 1.0f; u += 0.1f)
        for (float v = 0.05f; v < 1.0f; v += 0.1f) {
            const Ray ray = lens->camera().sample_ray(0.5f * size, {u, v});
            const bool in = glm::length(ray.at(ray.t_min)) < 1.0f;
            ++(in ? inside : outside);
            REQUIRE(sigma(lens->eye_medium_state(ray)) == (in ? 1.0f : 0.0f));
        }
    CHECK(inside > 10);
    CHECK(outside > 10);
    // Far from all boundaries, one state serves.
    const auto far = scene_with("<sensor type='perspective'/>" + sphere("9", in_a + null_bsdf));
    CHECK(sigma(far->eye_medium_state(far->camera().sample_ray({0, 0}, {0, 0}))) == 0);
}

TEST_CASE("Light from infinity is refused in a medium without end", "[scene][media][input]") {
    const std::string sky = "<emitter type='constant'/>\n";
    const auto error = [](const std::string& body) {
        try {
            scene_with(body);
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    // Media take two lines after the one that load_body() begins with.
    for (const std::string& naming : {sensor_in_a, light_in_a, sphere("20", out_a)}) {
        INFO(naming);
        contains(error(naming + sky), "test.xml:4: no light from infinity comes through the medium");
    }
    // Media that end, or that extinguish nothing, and lights that do not come from infinity.
    CHECK(error(sphere("0", in_a + null_bsdf) + sky).empty());
    CHECK(error(sensor_in_a + light_in_a).empty());
    CHECK_NOTHROW(
        load_body("<sensor type='perspective'><medium type='homogeneous'><float name='sigma_t' value='0'/>"
                  "</medium></sensor>" +
                  sky));
}
