// The scenes that the project ships: what the plan says of each, and that a tiny render of each is sound.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/formats/pictures/image_file.h"
#include "core/metrics/metrics.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::tests;

namespace {

const std::string scenes = MOTE_SOURCE_DIR "/scenes/";

void run_tool(const std::string& tool, const std::string& options, const std::string& output) {
    const std::string command =
        "\"" MOTE_BINARY_DIR "/" + tool + "\" " + options + " -o \"" + output + "\" >/dev/null 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
}

/// Small grids of smoke and cloud, made by the project's own simulation.
void make_grid(const TemporaryFolder& folder, const std::string& name, const std::string& options) {
    run_tool("mote_smoke", options, folder.file(name));
}

std::string plan_of(const TemporaryFolder& folder, const std::string& scene, const std::string& integrator,
                    const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"plan", scenes + scene, "--integrator", integrator};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult result = run_mote(folder, arguments);
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    return result.out;
}

double mean(const core::ImageChannels& picture, const std::string& layer) {
    double sum = 0.0;
    for (const core::Rgb& pixel : picture.rgb(layer)) sum += double(core::average(pixel));
    return sum / double(picture.width * picture.height);
}

/// Checks the renders of volpath and mote_vpl: every layer has light unless its name begins with an entry of
/// `black`, and both agree in emission and direct light, which they sample alike. With media along the way
/// the two differ by noise: 4.5 standard errors over pixels, which are independent in these layers.
void check_light(const TemporaryFolder& folder, const std::vector<std::string>& black) {
    std::vector<core::ImageChannels> pictures;
    std::vector<std::vector<core::Rgb>> near;
    for (const char* integrator : {"volpath", "mote_vpl"}) {
        const auto& picture =
            pictures.emplace_back(core::read_exr(folder.file(std::string(integrator) + ".exr")));
        CHECK(mean(picture, "") > 0.0);
        int layers = 0;
        for (const std::string& name : picture.names) {
            if (!name.ends_with(".R")) continue;
            const std::string layer = name.substr(0, name.size() - 2);
            INFO(integrator << ", layer " << layer);
            const bool expected =
                std::none_of(black.begin(), black.end(), [&](const auto& b) { return layer.starts_with(b); });
            CHECK((mean(picture, layer) > 0.0) == expected);
            ++layers;
        }
        CHECK(layers >= 3);
        near.push_back(picture.rgb("emission"));
        const auto direct = picture.rgb("direct");
        for (std::size_t i = 0; i < direct.size(); ++i) near.back()[i] += direct[i];
    }
    const auto m = core::compare_images(near[1], near[0], pictures[0].width, pictures[0].height);
    INFO("direct light of mote_vpl is off by " << m.mean_difference << " +- "
                                               << m.mean_difference_standard_error);
    CHECK(std::abs(m.mean_difference) <= 4.5 * m.mean_difference_standard_error);
}

/// Renders a tiny picture with one integrator; returns the statistics.
nlohmann::json tiny_render(const TemporaryFolder& folder, const std::string& scene,
                           const std::string& integrator, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"render",
                                          scenes + scene,
                                          "-o",
                                          folder.file(integrator + ".exr"),
                                          "--integrator",
                                          integrator,
                                          "--passes",
                                          "2",
                                          "--quiet",
                                          "--stats",
                                          folder.file("s.json"),
                                          "-D",
                                          "film.width=24",
                                          "-D",
                                          "film.height=16"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult result = run_mote(folder, arguments);
    INFO(scene << " " << integrator << ": " << result.err);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(read_file(folder.file("s.json")));
}

}  // namespace

TEST_CASE("The plan names what a scene requires", "[scenes][plan]") {
    const TemporaryFolder folder;
    for (const char* integrator : {"path", "volpath", "mote_vpl"}) {
        const std::string cornell = plan_of(folder, "cornell_box.xml", integrator);
        INFO(cornell);
        CHECK(cornell.find("no code for media runs") != std::string::npos);
        CHECK(cornell.find("the scene has none") != std::string::npos);
        CHECK(cornell.find("tracking") == std::string::npos);
    }
    for (const char* integrator : {"volpath", "mote_vpl"}) {
        const std::string fog = plan_of(folder, "fog_grille.xml", integrator);
        INFO(fog);
        CHECK(fog.find("analytic") != std::string::npos);
        CHECK(fog.find("homogeneous, extinction") != std::string::npos);
        CHECK(fog.find("majorants") == std::string::npos);
    }
    make_grid(folder, "smoke.vdb", "--size 24 24 24 --steps 24");
    for (const char* integrator : {"volpath", "mote_vpl"}) {
        const std::string smoke =
            plan_of(folder, "smoke_room.xml", integrator, {"-D", "smoke=" + folder.file("smoke.vdb")});
        INFO(smoke);
        CHECK(smoke.find("the grid's majorants") != std::string::npos);
        CHECK(smoke.find("unbiased_ray_marching") != std::string::npos);
        CHECK(smoke.find("vdbvolume") != std::string::npos);
    }
}

TEST_CASE("Every scene renders without a sample that is not finite, and none is black", "[scenes][render]") {
    const TemporaryFolder folder;
    make_grid(folder, "smoke.vdb", "--size 24 24 24 --steps 24");
    make_grid(folder, "cloud.vdb", "--size 24 24 24 --cell 40 --cloud");
    const std::vector<std::string> smoke = {"-D", "smoke=" + folder.file("smoke.vdb")};
    const std::vector<std::string> cloud = {"-D", "cloud=" + folder.file("cloud.vdb")};
    using Words = std::vector<std::string>;
    const Words none, lamps_out_of_view = {"emission"}, no_surfaces = {"direct", "indirect"};
    for (const auto& [scene, options, black] : {std::tuple{"cornell_box.xml", none, none},
                                                {"fog_grille.xml", none, lamps_out_of_view},
                                                {"smoke_room.xml", smoke, lamps_out_of_view},
                                                {"cloud.xml", cloud, no_surfaces}}) {
        for (const char* integrator : {"volpath", "mote_vpl"}) {
            const auto statistics = tiny_render(folder, scene, integrator, options);
            INFO(scene << " " << integrator);
            CHECK(statistics["non_finite_samples"] == 0);
            if (scene == std::string("cornell_box.xml")) {
                // Without media nothing is spent on volumes: the counters do not even exist.
                CHECK(statistics["lookups"].empty());
                CHECK_FALSE(statistics["rays"].contains("boundary"));
            } else {
                CHECK(statistics["lookups"]["collisions"] > 0);
                CHECK(statistics["lookups"]["step_limit_fallbacks"] == 0);
            }
        }
        check_light(folder, black);
    }
}

TEST_CASE("The scenes with generated meshes render without a warning, and none is black",
          "[scenes][render]") {
    const TemporaryFolder folder;
    make_grid(folder, "clouds.vdb", "--size 24 12 24 --cell 40 --cloud");
    run_tool("mote_geometry", "sky", folder.path());
    using Words = std::vector<std::string>;
    const Words none, lamps_out_of_view = {"emission"};
    for (const auto& [scene, mesh, more, black] :
         {std::tuple{"atrium", "atrium", Words{}, none},
          {"statue", "rotunda", {"-D", "g=-0.6"}, none},
          {"screen", "screen", {}, lamps_out_of_view},
          {"window", "window", {}, lamps_out_of_view},
          {"tree", "tree", {}, none},
          {"lights", "lantern", {}, lamps_out_of_view},
          {"mist", "rotunda", {"-D", "mist=" + folder.file("clouds.vdb")}, none},
          {"city",
           "city",
           {"-D", "clouds=" + folder.file("clouds.vdb"), "-D", "sky=" + folder.file("sky.exr")},
           none}}) {
        run_tool("mote_geometry", std::string(mesh) + " --detail 0.1", folder.path());
        std::vector<std::string> options = {"-D", "meshes=" + folder.path()};
        options.insert(options.end(), more.begin(), more.end());
        for (const char* integrator : {"volpath", "mote_vpl"}) {
            const auto statistics = tiny_render(folder, scene + std::string(".xml"), integrator, options);
            INFO(scene << " " << integrator << " " << statistics.dump());
            CHECK(statistics["non_finite_samples"] == 0);
            CHECK(statistics["lookups"]["step_limit_fallbacks"] == 0);
        }
        check_light(folder, black);
        // A mesh that had to be repaired would be a note of the plan.
        CHECK(plan_of(folder, scene + std::string(".xml"), "volpath", options).find("dropped") ==
              std::string::npos);
    }
}
