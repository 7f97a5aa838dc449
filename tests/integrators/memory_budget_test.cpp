// Every method that stores lights, maps, points or texels compares them with the budget before it makes them.
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "core/render/pass_runner.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

const std::string medium =
    R"(<medium name="interior" type="homogeneous"><float name="sigma_t" value="0.5"/></medium>)";

/// Words of the error of a first pass with so many bytes; "" where there is none.
std::string refusal(const Scene& scene, const std::string& type, const std::string& settings, double bytes) {
    const auto integrator =
        integrator_from("<integrator type=\"" + type + "\">" + settings + "</integrator>");
    Film film(scene.film().width, scene.film().height, integrator->layers(scene));
    const std::atomic<bool> cancelled{false};
    try {
        PassRunner runner(scene, *integrator, 3, film, {}, {}, MemoryBudget(bytes));
        runner.run_pass(cancelled);
    } catch (const OutOfMemory& error) {
        return error.what();
    } catch (const InputError& error) {  // a limit of the method's own, which the budget lowered
        return error.what();
    }
    return "";
}

/// Words of the error of mote_upbp's first pass of an image in so many bytes; "" where there is none. Without
/// beams, of which a small image has more for each subpath.
std::string refused_subpaths(const Scene& scene, int width, int height, double bytes) {
    RenderOptions options{.seed = 3, .width = width, .height = height};
    options.memory = MemoryBudget(bytes);
    const auto integrator =
        integrator_from(R"(<integrator type="mote_upbp"><boolean name="bb1d" value="false"/>
                           <string name="efforts" value="equal"/></integrator>)");
    const bool small = width * height < 100000;  // many are refused before any pixel is written
    PassImage image(small ? width : 1, small ? height : 1, integrator->layers(scene).size());
    const std::atomic<bool> cancelled{false};
    const auto filter = film_filter(scene);
    try {
        integrator->prepare(scene, options)->pass({0, *filter, cancelled}, image);
    } catch (const OutOfMemory& error) {
        return error.what();
    }
    return "";
}

std::string number(const std::string& name, int value) {
    return "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
}

}  // namespace

TEST_CASE("Methods refuse what exceeds the budget, and name it", "[memory]") {
    struct Case {
        std::string type, settings, words;
        bool media = false;
    };
    const std::string many = number("paths", 40000);
    const Case cases[] = {
        {"mote_vpl", many, "the virtual point lights of 40000 light paths"},
        {"mote_vsl", many, "the virtual point lights of 40000 light paths"},
        {"mote_vpl_ray_bundles", many, "the virtual point lights of 40000 light paths"},
        {"mote_ray_lights", many, "the ray lights of 40000 light paths", true},
        {"mote_photon_map", number("photon_paths", 40000), "the photons of 40000 light paths"},
        {"mote_upbp", "", "the vertices of 16 light subpaths"},
        {"mote_vpl", R"(<selection type="lightcuts"/>)", "selecting from "},
        {"mote_vpl", R"(<visibility type="shadow_map"/>)", " shadow map(s) of ", true},
        {"mote_vpl", R"(<visibility type="imperfect_shadow_map"/>)", " imperfect shadow maps of "},
        {"mote_micro_rendering", "", "triangles"},
        {"mote_ray_bundles", "", "triangles"}};
    for (const Case& c : cases) {
        const auto scene = scene_from(box(grey, c.media ? medium : ""), 4);
        const std::string said = refusal(*scene, c.type, c.settings, 500.0);
        INFO(c.type << " " << c.settings << ": " << said);
        CHECK(said.find(c.words) != std::string::npos);
    }
    const auto scene = scene_from(box(grey, ""), 4);
    CHECK(refusal(*scene, "mote_micro_rendering", "", 1e5).find("65536 points") != std::string::npos);
    CHECK(refusal(*scene, "mote_upbp", "", 2000.0).find("subpaths fit") != std::string::npos);
    CHECK(refusal(*scene, "mote_vpl", R"(<selection type="lightcuts"/>)", 1e9).empty());
}

TEST_CASE("1e8 light subpaths are refused, with the number that fits", "[memory][upbp]") {
    const auto scene = scene_from(box(grey, medium), 4);
    const auto fits = [&](int width, int height, double bytes) {
        const std::string said = refused_subpaths(*scene, width, height, bytes);
        INFO(said);
        const std::string words = " available; ", count = std::to_string(width * height);
        CHECK(said.find("the vertices of " + count + " light subpaths") != std::string::npos);
        CHECK(said.find(" subpaths fit") != std::string::npos);
        const std::size_t begin = said.find(words);
        REQUIRE(begin != std::string::npos);
        return std::stoi(said.substr(begin + words.size()));
    };
    CHECK(std::abs(fits(10000, 10000, 2e9) - 2 * fits(10000, 10000, 1e9)) <= 1);
    const int rows = fits(8, 1000, 1e6) / 8;
    CHECK(rows > 8);
    CHECK(refused_subpaths(*scene, 8, rows, 1e6).empty());
    CHECK_FALSE(refused_subpaths(*scene, 8, rows + 1, 1e6).empty());
}
