// --lenient: what can be loaded is, and every word left out or replaced is reported.
#include "core/formats/xml/faults.h"
#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

struct Loaded {
    std::unique_ptr<Scene> scene;
    std::vector<std::string> approximations;
    const Scene* operator->() const { return scene.get(); }
};

Loaded load_leniently(const std::string& body) {
    LoadOptions options;
    LoadReport report;
    options.lenient = true, options.report = &report;
    auto scene = load_body(body, options);
    return {std::move(scene), report.approximations};
}

Rgb albedo_of(const Bsdf& bsdf) {
    const Vec3 up(0, 0, 1);
    return bsdf.eval({}, up, up, TransportMode::radiance) * pi;
}

}  // namespace

TEST_CASE("A sound scene is loaded without approximations", "[scene][lenient]") {
    CHECK(load_leniently("<shape type='sphere'/>").approximations.empty());
}

TEST_CASE("Unknown BSDFs are grey, unknown shapes left out, unknown values ignored", "[scene][lenient]") {
    const std::string body = R"(<bsdf type="velvet" id="a"><rgb name="reflectance" value="0.9"/></bsdf>
        <shape type="sphere"><ref id="a"/><float name="gloss" value="3"/></shape>
        <shape type="torus"><bsdf type="diffuse"/></shape>
        <shape type="cube"><bsdf type="twosided"><bsdf type="suede"/></bsdf></shape>
        <shape type="sphere"><float name="radius" value="big"/><ref id="b"/></shape>
        <emitter type="constant"/><emitter type="moonlight"/>
        <mesh/>)";
    CHECK(load_error(scene_xml(body)) != "");
    const auto scene = load_leniently(body);
    REQUIRE(scene->shapes().size() == 3);
    CHECK(albedo_of(*scene->shapes()[0]->bsdf).x == Approx(0.5));
    CHECK(albedo_of(*scene->shapes()[1]->bsdf).x == Approx(0.5));
    CHECK(albedo_of(*scene->shapes()[2]->bsdf).x == Approx(0.5));
    CHECK(scene->emitters().size() == 1);
    const std::vector<std::string> expected = {"test.xml:2: unknown bsdf type 'velvet'",
                                               ": a grey diffuse stands in its place",
                                               "test.xml:3: shape 'sphere' has no parameter 'gloss'",
                                               ": ignored",
                                               "test.xml:4: unknown shape type 'torus'",
                                               ": left out",
                                               "test.xml:5: unknown bsdf type 'suede'",
                                               ": a grey diffuse stands in its place",
                                               "test.xml:6: 'big' is not a number",
                                               ": ignored",
                                               "test.xml:6: nothing has the id 'b'",
                                               ": ignored",
                                               "test.xml:7: unknown emitter type 'moonlight'",
                                               ": left out",
                                               "test.xml:8: unknown element <mesh>",
                                               ": ignored"};
    const auto& notes = scene.approximations;
    for (std::size_t i = 0; i < expected.size(); i += 2) {
        INFO(expected[i]);
        const auto found = std::find_if(notes.begin(), notes.end(),
                                        [&](const std::string& t) { return t.starts_with(expected[i]); });
        REQUIRE(found != notes.end());
        CHECK(found->ends_with(expected[i + 1]));
    }
    CHECK(notes.size() == expected.size() / 2);
}

TEST_CASE("A value that an object cannot be made with is ignored", "[scene][lenient]") {
    const auto scene = load_leniently("<shape type='sphere'>\n<float name='radius' value='-1'/></shape>");
    REQUIRE(scene->shapes().size() == 1);
    REQUIRE(scene.approximations.size() == 1);
    CHECK(scene.approximations[0].starts_with("test.xml:3: 'radius'"));
    const auto without = load_leniently(
        "<shape type='obj'><string name='filename' value='none.obj'/></shape>"
        "<shape type='sphere'/>");
    CHECK(without->shapes().size() == 1);
    CHECK(without.approximations.size() == 1);
}

TEST_CASE("Names that nothing defines, double ids and attributes", "[scene][lenient]") {
    const auto scene = load_leniently(R"(<shape type="sphere" id="s"/>
        <shape type="cube" id="s" colour="red"/>
        <shape type="sphere"><float name="radius" value="$r"/></shape>)");
    CHECK(scene->shapes().size() == 3);
    CHECK(scene.approximations.size() == 2);
}

TEST_CASE("What leniency cannot mend is still an error", "[scene][lenient]") {
    LoadOptions options;
    options.lenient = true;
    CHECK(load_error("<scene version='3.0.0'>\n<shape>\n</scene>", options) != "");
    options.defines = {{"nothing", "1"}};
    CHECK(contains(load_error(scene_xml("<shape type='spere'/>"), options), "-D nothing"));
}
