// A scene of instances has the same picture as one of copied meshes, in every method: eye paths, light paths
// and photons that meet instanced surfaces, glass, panes and fog; and the same bits whatever the number of
// threads.
#include <fmt/format.h>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string moved(const std::string& transform, const std::string& inner = "") {
    return "<transform name=\"to_world\">" + inner + transform + "</transform>";
}

/// A block, a pane and a cube of fog, all meshes; `place` follows the shapes' own transforms.
std::string furniture(const std::string& place) {
    const auto shape = [&](const std::string& type, const std::string& own, const std::string& content) {
        return "<shape type=\"" + type + "\">" + moved(place, own) + content + "</shape>";
    };
    return shape("cube", R"(<scale x="0.2" y="0.3" z="0.2"/>)", mixed) +
           shape("rectangle", R"(<scale value="0.4"/><translate y="0.1" z="0.35"/>)",
                 R"(<bsdf type="thindielectric"/>)") +
           shape("cube", R"(<scale value="0.25"/><translate y="0.6"/>)",
                 R"(<bsdf type="null"/>)" + fog("2, 1.5, 1", ""));
}

constexpr const char* places[] = {
    R"(<rotate y="1" angle="25"/><translate x="-0.45" y="-0.65" z="-0.2"/>)",
    R"(<scale x="-0.8" y="0.7" z="1.1"/><rotate z="1" angle="30"/><translate x="0.5" y="-0.2" z="-0.1"/>)"};

std::string scene_of(bool instances) {
    std::string xml = box(grey, "");
    std::string shapes =
        instances ? R"(<shape type="shapegroup" id="furniture">)" + furniture("") + "</shape>" : "";
    for (const char* place : places)
        shapes += instances ? "<shape type=\"instance\"><ref id=\"furniture\"/>" + moved(place) + "</shape>"
                            : furniture(place);
    return xml.insert(xml.find("<sensor"), shapes);
}

}  // namespace

TEST_CASE("instances render as copies do, in every method", "[instances][equality]") {
    const auto instanced = scene_from(scene_of(true), 8), copied = scene_from(scene_of(false), 8);
    struct Method {
        const char* xml;
        std::uint32_t passes;
    };
    const Method methods[] = {
        {R"(<integrator type="volpath"><integer name="max_depth" value="5"/></integrator>)", 300},
        {R"(<integrator type="mote_vpl"><integer name="paths" value="8"/><float name="bound" value="1"/></integrator>)",
         100},
        {R"(<integrator type="mote_photon_map"><integer name="photon_paths" value="100"/></integrator>)",
         60}};
    for (const Method& method : methods) {
        INFO(method.xml);
        const auto a = render_statistics(*instanced, *integrator_from(method.xml), {4, method.passes, 1});
        const auto b = render_statistics(*copied, *integrator_from(method.xml), {4, method.passes, 2});
        CHECK(a.non_finite == 0);
        check_same_mean(a, "beauty", b, "beauty", {1.25});
        // With the same seed the same paths are sampled, but for rounding where they meet edges.
        const auto same_seed =
            render_statistics(*copied, *integrator_from(method.xml), {4, method.passes, 1});
        for (std::size_t channel = 0; channel < 3; ++channel)
            CHECK(a.whole[a.layer("beauty")][channel].mean ==
                  Approx(same_seed.whole[a.layer("beauty")][channel].mean).epsilon(0.02));
    }
}
