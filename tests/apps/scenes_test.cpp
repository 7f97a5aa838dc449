// The scenes that the project ships: what the plan says of each, and that a tiny render of each is sound.
#include <nlohmann/json.hpp>

#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

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

/// Renders a tiny picture with one integrator; returns the statistics.
nlohmann::json tiny_render(const TemporaryFolder& folder, const std::string& scene,
                           const std::string& integrator, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"render",
                                          scenes + scene,
                                          "-o",
                                          folder.file("tiny.exr"),
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
        CHECK(smoke.find("ratio_tracking") != std::string::npos);
        CHECK(smoke.find("vdbvolume") != std::string::npos);
    }
}

TEST_CASE("Every scene renders without a sample that is not finite", "[scenes][render]") {
    const TemporaryFolder folder;
    make_grid(folder, "smoke.vdb", "--size 24 24 24 --steps 24");
    make_grid(folder, "cloud.vdb", "--size 24 24 24 --cloud");
    const std::vector<std::string> smoke = {"-D", "smoke=" + folder.file("smoke.vdb")};
    const std::vector<std::string> cloud = {"-D", "cloud=" + folder.file("cloud.vdb")};
    for (const char* integrator : {"volpath", "mote_vpl"}) {
        const auto cornell = tiny_render(folder, "cornell_box.xml", integrator);
        CHECK(cornell["non_finite_samples"] == 0);
        // Without media nothing is spent on volumes: the counters do not even exist.
        CHECK(cornell["lookups"].empty());
        CHECK_FALSE(cornell["rays"].contains("boundary"));

        for (const auto& [scene, options] :
             {std::pair{"fog_grille.xml", std::vector<std::string>{}}, std::pair{"smoke_room.xml", smoke},
              std::pair{"cloud.xml", cloud}}) {
            const auto statistics = tiny_render(folder, scene, integrator, options);
            INFO(scene << " " << integrator);
            CHECK(statistics["non_finite_samples"] == 0);
            CHECK(statistics["lookups"]["collisions"] > 0);
            CHECK(statistics["lookups"]["step_limit_fallbacks"] == 0);
        }
    }
}

TEST_CASE("The scenes with generated meshes render without a warning or a sample that is not finite",
          "[scenes][render]") {
    const TemporaryFolder folder;
    make_grid(folder, "clouds.vdb", "--size 24 12 24 --cell 40 --cloud");
    run_tool("mote_geometry", "sky", folder.path());
    for (const auto& [scene, mesh, more] :
         {std::tuple{"atrium", "atrium", std::vector<std::string>{}},
          {"statue", "rotunda", {"-D", "g=-0.6"}},
          {"screen", "screen", {}},
          {"window", "window", {}},
          {"tree", "tree", {}},
          {"lights", "lantern", {}},
          {"mist", "rotunda", {"-D", "mist=" + folder.file("clouds.vdb")}},
          {"city",
           "city",
           {"-D", "clouds=" + folder.file("clouds.vdb"), "-D", "sky=" + folder.file("sky.exr")}}}) {
        run_tool("mote_geometry", std::string(mesh) + " --detail 0.1", folder.path());
        std::vector<std::string> options = {"-D", "meshes=" + folder.path()};
        options.insert(options.end(), more.begin(), more.end());
        for (const char* integrator : {"volpath", "mote_vpl"}) {
            const auto statistics = tiny_render(folder, scene + std::string(".xml"), integrator, options);
            INFO(scene << " " << integrator << " " << statistics.dump());
            CHECK(statistics["non_finite_samples"] == 0);
            CHECK(statistics["lookups"]["step_limit_fallbacks"] == 0);
        }
        // A mesh that had to be repaired would be a note of the plan.
        CHECK(plan_of(folder, scene + std::string(".xml"), "volpath", options).find("dropped") ==
              std::string::npos);
    }
}
