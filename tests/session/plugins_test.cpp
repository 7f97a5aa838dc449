// Plugins in the process: the types of the examples do what they say, and what does not fit is refused.
#include "session/plugins.h"

#include <cmath>

#include "core/formats/xml/scene_loader.h"
#include "core/objects/error.h"
#include "session/loaded_scene.h"
#include "session/registry.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using core::InputError;
using tests::check_mean_is, tests::check_same_mean, tests::render_statistics, tests::RenderStatistics;

namespace {

std::string plugin(const std::string& name) { return MOTE_BINARY_DIR "/stand_ins/" + name + ".so"; }

const core::Registry& with_examples() {
    static const core::Registry registry =
        session::make_registry(std::vector{plugin("my_integrator"), plugin("my_selector")});
    return registry;
}

std::unique_ptr<core::Scene> scene_of(const std::string& integrator, const std::string& content) {
    return core::load_scene_from_string(R"(<scene version="3.0.0">)" + integrator +
                                            R"(<sensor type="perspective"><float name="fov" value="40"/>
        <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/>
        <rfilter type="box"/></film><transform name="to_world">
        <lookat origin="0, 3, 2" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>)" +
                                            content + "</scene>",
                                        ".", with_examples());
}

/// A floor of reflectance 1/2, and a board of `height` above it that covers all directions but the grazing
/// ones; a light between them.
std::string floor_and_board(double height) {
    return R"(<bsdf type="diffuse" id="grey"><rgb name="reflectance" value="0.5"/></bsdf>
        <shape type="rectangle"><transform name="to_world"><scale value="9"/><rotate x="1" angle="-90"/>
        </transform><ref id="grey"/></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="900"/><rotate x="1" angle="90"/>
        <translate y=")" +
           std::to_string(height) + R"("/></transform><ref id="grey"/></shape>
        <emitter type="point"><point name="position" x="1" y="2" z="0.5"/>
        <rgb name="intensity" value="5, 3, 1"/></emitter>)";
}

std::string ambient(const std::string& more) {
    return R"(<integrator type="my_ambient_occlusion"><rgb name="ambient" value="0.4"/>)" + more +
           "</integrator>";
}

RenderStatistics rendered(const core::Scene& scene) {
    return render_statistics(scene, *scene.integrator(), {.passes = 64});
}

}  // namespace

TEST_CASE("A plugin's integrator renders with its own parameters", "[session][plugins]") {
    // Free directions reflect 0.5 * 0.4, and with a cosine-distributed direction there is no noise.
    const auto open = scene_of(ambient(R"(<float name="distance" value="1"/>)"), floor_and_board(4.0));
    check_mean_is(rendered(*open), "indirect_ambient", 0.2, {1.01});
    // A board at height h hides what leaves within arccos(h / d): the cosine-weighted rest is (h / d)^2.
    const auto hidden = scene_of(ambient(R"(<float name="distance" value="5"/>)"), floor_and_board(4.0));
    check_mean_is(rendered(*hidden), "indirect_ambient", 0.2 * 0.64, {1.03});
    CHECK_THROWS_WITH(scene_of(ambient(R"(<float name="distnce" value="1"/>)"), floor_and_board(4.0)),
                      ContainsSubstring("did you mean 'distance'"));
    CHECK_THROWS_WITH(scene_of(ambient(R"(<float name="distance" value="0"/>)"), floor_and_board(4.0)),
                      ContainsSubstring("above 0"));
}

TEST_CASE("A plugin's selection is unbiased", "[session][plugins]") {
    const auto vpl = [&](const std::string& selection) {
        return scene_of(R"(<integrator type="mote_vpl"><integer name="paths" value="64"/>
                           <integer name="max_depth" value="4"/><float name="bound" value="0.1"/>)" +
                            selection + "</integrator>",
                        floor_and_board(4.0));
    };
    const auto all = vpl(""), some = vpl(R"(<selection type="by_intensity" name="selection">
                                            <integer name="samples" value="16"/></selection>)");
    const auto a = render_statistics(*all, *all->integrator(), {.passes = 1024}),
               b = render_statistics(*some, *some->integrator(), {.passes = 1024, .seed = 2});
    check_same_mean(a, "indirect_bounded", b, "indirect_bounded", {1.06});
}

TEST_CASE("What is no plugin of this mote is refused with its file", "[session][plugins]") {
    core::Registry registry = session::make_registry();
    const auto refuses = [&](const std::string& file, const std::string& part) {
        CHECK_THROWS_AS(session::load_plugin(registry, file), InputError);
        CHECK_THROWS_WITH(session::load_plugin(registry, file),
                          ContainsSubstring(file) && ContainsSubstring(part));
    };
    refuses("nowhere.so", "there is no such plugin");
    refuses(MOTE_BINARY_DIR, "there is no such plugin");  // a folder
    refuses(MOTE_BINARY_DIR "/../CMakeCache.txt", "cannot be loaded");
    refuses(MOTE_BINARY_DIR "/stand_ins/libOpenImageDenoise.so.2", "is no plugin of mote");
    refuses(plugin("old_plugin"), "compiled for mote 0.0.9, interface 000000000000");
    refuses(plugin("old_plugin"), "and this is mote " MOTE_VERSION);
    refuses(plugin("clashing_plugin"), "integrator 'path' is registered twice");
    CHECK(registry.types(core::Category::integrator) ==
          session::make_registry().types(core::Category::integrator));
}

TEST_CASE("Changes to a scene have their options of the command line", "[session][plugins]") {
    session::SceneChanges changes{"path", {{"film.width", "8"}}, true};
    changes.plugins = {"my.so"};
    CHECK(session::command_options(changes) == std::vector<std::string>{"--integrator", "path", "-D",
                                                                        "film.width=8", "--lenient",
                                                                        "--plugin", "my.so"});
    CHECK(session::command_options({}).empty());
}
