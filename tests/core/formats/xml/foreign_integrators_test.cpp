// Integrators of Mitsuba as ours, and what --integrator makes of a file's own.
#include "core/formats/xml/foreign_integrators.h"
#include "core/formats/xml/scene_loader.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

SceneDocument document_of(const std::string& integrator) {
    SceneDefines defines({});
    return read_scene_text(scene_xml(integrator), ".", "test.xml", defines);
}

Element replaced(const std::string& integrator, SceneDocument& document) {
    document = document_of(integrator);
    replace_foreign_integrators(document, test_registry());
    return *document.scene.child_with_tag("integrator");
}
Element replaced(const std::string& integrator) {
    SceneDocument document;
    return replaced(integrator, document);
}

std::unique_ptr<Scene> with_integrator(const std::string& body, const std::string& type = "fake") {
    LoadOptions options;
    options.integrator = type;
    return load_body(body, options);
}
bool warned(const Scene& scene, const std::string& text) {
    for (const std::string& w : scene.parts().warnings)
        if (w.find(text) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("Integrators of Mitsuba are ours by another name", "[scene][foreign]") {
    Element direct =
        replaced("<integrator type='direct'><integer name='emitter_samples' value='4'/></integrator>");
    CHECK(direct.get("type") == "path");
    REQUIRE(direct.child("max_depth"));
    CHECK(direct.child("max_depth")->get("value") == "2");
    CHECK(replaced("<integrator type='volpathmis'/>").get("type") == "volpath");
    CHECK(replaced("<integrator type='ptracer'/>").get("type") == "path");
    CHECK(replaced("<integrator type='fake'/>").get("type") == "fake");
}

TEST_CASE("Nested integrators take the place of aov, moment and stokes", "[scene][foreign]") {
    SceneDocument document;
    Element inner = replaced(R"(<integrator type="moment"><integrator type="aov" name="a">
        <string name="aovs" value="d:depth, nn:sh_normal,u:uv"/><integrator type="volpathmis" name="image">
        <integer name="max_depth" value="3"/></integrator></integrator></integrator>)",
                             document);
    CHECK(inner.get("type") == "volpath");
    CHECK(inner.child("max_depth")->get("value") == "3");
    CHECK(document.features == std::vector<std::string>{"Depth", "Ns"});
    std::string all;
    for (const std::string& w : document.warnings) all += w + "\n";
    CHECK(contains(all, "integrator 'moment' is replaced by 'volpath'"));
    CHECK(contains(all, "integrator 'aov' is replaced by 'volpath'"));
    CHECK(contains(all, "the feature 'uv' of 'aov' has no layer here"));
    CHECK(replaced("<integrator type='stokes'><integrator type='fake'/></integrator>").get("type") == "fake");
}

TEST_CASE("Every replacement is by a type that exists or a nested one", "[scene][foreign]") {
    for (const ForeignIntegrator& f : foreign_integrators()) {
        INFO(f.from);
        const std::string to = f.to;
        CHECK((to == "path" || to == "volpath" || to.empty()));
        CHECK(std::string(f.note) != "");
    }
}

TEST_CASE("With --integrator whatever is wrong with the file's own is a warning", "[scene][foreign]") {
    const std::string rest = "<shape type='sphere'/>";
    const auto unknown =
        with_integrator("<integrator type='erpt'><integer name='chains' value='3'/></integrator>" + rest);
    CHECK(integrator_of(*unknown).type == "fake");
    CHECK(warned(*unknown, "test.xml:2: unknown integrator type 'erpt'"));
    CHECK(warned(*unknown, "'chains' is ignored"));
    const auto bad = with_integrator(
        "<integrator type='other'>\n<integer name='max_depth' value='many'/>\n"
        "<boolean name='flg' value='1'/></integrator>" +
        rest);
    CHECK(value_of<int>(integrator_of(*bad), "max_depth", -7) == -7);
    CHECK(warned(*bad, "test.xml:3: 'many' is not an integer"));
    CHECK(warned(*bad, "test.xml:4: 'flg' is ignored"));
    const auto two = with_integrator("<integrator type='other'/><integrator type='other'/>" + rest);
    CHECK(warned(*two, "more than one integrator"));
    // Beside an integrator of the requested type, settings of the other type are not used.
    const std::string settings =
        "<integrator type='other'><integer name='max_depth' value='3'/></integrator>"
        "<integrator type='fake'><integer name='max_depth' value='6'/></integrator>";
    const auto chosen = with_integrator(settings + rest);
    CHECK(integrator_of(*chosen).type == "fake");
    CHECK(value_of<int>(integrator_of(*chosen), "max_depth") == 6);
    CHECK(chosen->parts().warnings.empty());
    const auto kept =
        with_integrator("<integrator type='other'><integer name='max_depth' value='5'/></integrator>" + rest);
    CHECK(value_of<int>(integrator_of(*kept), "max_depth") == 5);
    CHECK(kept->parts().warnings.empty());
    CHECK(load_error(scene_xml("<integrator type='erpt'/>" + rest)) != "");
}

TEST_CASE("A wrong value of the integrator that --integrator names is an error", "[scene][foreign]") {
    std::string message;
    try {
        with_integrator(
            "<integrator type='other'/><integrator type='fake'>\n<integer name='max_depth' "
            "value='many'/></integrator><shape type='sphere'/>");
    } catch (const InputError& error) {
        message = error.what();
    }
    CHECK(contains(message, "test.xml:3: 'many' is not an integer"));
}

TEST_CASE("Parameters of other integrators are known", "[scene][foreign]") {
    const auto scene = load_body(
        "<integrator type='fake'><integer name='samples_per_pass' value='4'/>"
        "<integer name='version' value='6'/></integrator><shape type='sphere'/>");
    CHECK(warned(*scene, "'samples_per_pass', 'version' of integrator 'fake' have no effect here"));
}

TEST_CASE("Elements that other renderers added are left out with a note", "[scene][foreign]") {
    const auto scene =
        load_body("<mode type='final'/><shape type='sphere'>\n<hide name='radius' value='x'/></shape>");
    CHECK(warned(*scene, "test.xml:2: <mode>: a mode of another renderer has no effect"));
    CHECK(warned(*scene, "test.xml:3: <hide>: a hidden element is left out"));
}
