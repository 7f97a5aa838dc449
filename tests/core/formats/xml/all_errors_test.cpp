// One run reports all that is wrong with a scene, in the order of its lines, and nothing twice.
#include <fstream>

#include "core/formats/xml/faults.h"
#include "tests/core/scene/scene_fixture.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

using Lines = std::vector<std::string>;

Lines errors_of(const std::function<void()>& loading) {
    Lines lines;
    try {
        loading();
    } catch (const SceneErrors& errors) {
        for (const InputError& e : errors.all()) lines.emplace_back(e.what());
    } catch (const InputError& error) {
        lines.emplace_back(error.what());
    }
    return lines;
}
Lines errors_of(const std::string& body, const LoadOptions& options = {}) {
    return errors_of([&] { load(scene_xml(body), options); });
}

}  // namespace

TEST_CASE("All errors of a file come at once, in its order", "[scene][errors]") {
    const Lines lines = errors_of(R"(<integrator type="fake"><integer name="max_depth" value="$deep"/>
        <float name="bond" value="1"/>
        <boolean name="flag" value="perhaps"/></integrator>
        <bsdf type="difuse" id="a"><rgb name="reflectance" value="0.5"/></bsdf>
        <shape type="sphere"><ref id="a"/>
            <float name="radius" value="many"/></shape>
        <shape type="sphere"><ref id="b"/></shape>
        <shap type="cube"/>
        stray
        <bsdf type="plastic" id="a"/>
        <shape type="obj"><string name="filename" value="nowhere.obj"/></shape>
        <include filename="nothing.xml"/>
        <shape type="sphere">
            <float name="radius" value="-1"/></shape>)");
    const Lines expected = {"test.xml:2: $deep is not defined",
                            "test.xml:3: integrator 'fake' has no parameter 'bond' (did you mean 'bound'?)",
                            "test.xml:4: 'perhaps' is neither true nor false",
                            "test.xml:5: unknown bsdf type 'difuse' (did you mean 'diffuse'?)",
                            "test.xml:7: 'many' is not a number",
                            "test.xml:8: nothing has the id 'b'",
                            "test.xml:9: unknown element <shap> (did you mean 'shape'?)",
                            "test.xml:9: text inside <scene>",
                            "test.xml:11: id 'a' is taken already by line 5",
                            "test.xml:12: file 'nowhere.obj' was not found",
                            "test.xml:13: file './nothing.xml' was not found",
                            "test.xml:15: 'radius'"};
    REQUIRE(lines.size() == expected.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        INFO(lines[i]);
        CHECK(lines[i].starts_with(expected[i]));
    }
}

TEST_CASE("The message of all errors is one line", "[scene][errors]") {
    const std::string body = "<shape type='spere'/>\n<shape type='cub'/>\n<bsdf type='difuse'/>";
    CHECK(load_error(scene_xml(body)) ==
          "test.xml:2: unknown shape type 'spere' (did you mean 'sphere'?) (and 2 more errors)");
}

TEST_CASE("Who needs what is wrong is not blamed as well", "[scene][errors]") {
    CHECK(errors_of(R"(<medium type="homogeneous" id="fog"><rgb name="sigma_t" value="1 2"/></medium>
        <shape type="sphere"><ref name="interior" id="fog"/></shape>
        <sensor type="perspective"><ref id="fog"/></sensor>)")
              .size() == 1);
    CHECK(
        errors_of(R"(<bsdf type="twosided" id="w"><bsdf type="diffus"/></bsdf><shape type="cube"><ref id="w"/>
        <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>)")
            .size() == 1);
}

TEST_CASE("Malformed XML stops at that", "[scene][errors]") {
    const Lines lines =
        errors_of([] { load("<scene version='3.0.0'>\n<shape type='spere'/>\n<bsdf>\n</scene>"); });
    REQUIRE(lines.size() == 1);
    CHECK(contains(lines[0], "test.xml:4: malformed XML"));
}

TEST_CASE("Errors of the command line come first", "[scene][errors]") {
    LoadOptions options;
    options.defines = {{"nothing", "1"}, {"sphere.radios", "2"}};
    const Lines lines = errors_of("<shape type='sphere'/>\n<shape type='spere'/>", options);
    REQUIRE(lines.size() == 3);
    CHECK(contains(lines[0], "-D nothing"));
    CHECK(contains(lines[1], "'radios'"));
    CHECK(contains(lines[2], "test.xml:3:"));
}

TEST_CASE("Errors of included files follow those of the file that includes them", "[scene][errors]") {
    const TemporaryFolder folder;
    const std::string main = folder.file("main.xml");
    std::ofstream(folder.file("part.xml")) << "<scene version='3.0.0'>\n<shape type='spere'/>\n</scene>";
    std::ofstream(main) << scene_xml("<shape type='cub'/>\n<include filename='part.xml'/>\n<bsdf type='x'/>");
    const Lines lines = errors_of([&] { load_scene(main, test_registry()); });
    REQUIRE(lines.size() == 3);
    CHECK(contains(lines[0], "main.xml:2:"));
    CHECK(contains(lines[1], "main.xml:4:"));
    CHECK(contains(lines[2], "part.xml:2:"));
}

TEST_CASE("Errors in the middle of big files are found, up to a thousand", "[scene][errors]") {
    std::string body;
    for (int i = 0; i < 3000; ++i)
        body += i == 1234   ? "<bsdf type='difuse'/>\n"
                : i == 2345 ? "<bsdf type='diffuse'><rgb name='reflectance' value='x'/></bsdf>\n"
                            : "<bsdf type='diffuse'><rgb name='reflectance' value='0.5'/></bsdf>\n";
    const Lines lines = errors_of(body);
    REQUIRE(lines.size() == 2);
    CHECK(contains(lines[0], "test.xml:1236: unknown bsdf type 'difuse'"));
    CHECK(contains(lines[1], "test.xml:2347: 'x' is not a number"));
    std::string worse;
    for (int i = 0; i < 3000; ++i) worse += "<bsdf type='difuse'/>\n";
    CHECK(errors_of(worse).size() == 1000);
}
