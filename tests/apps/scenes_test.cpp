// The scenes that the project ships: what the plan says of each, and that a tiny render of each is sound.
#include <nlohmann/json.hpp>

#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

const std::string scenes = MOTE_SOURCE_DIR "/scenes/";

/// Small grids of smoke and cloud, made by the project's own simulation.
void make_grid(const TemporaryFolder& folder, const std::string& name, const std::string& options) {
    const std::string command = std::string("\"" MOTE_BINARY_DIR "/mote_smoke\" ") + options + " -o \"" +
                                folder.file(name) + "\" >/dev/null 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
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
