// --plugin and MOTE_PLUGINS: a plugin's integrator takes part in every command.
#include <cstdlib>
#include <filesystem>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/ball_under_sky.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

const std::string plugin = MOTE_BINARY_DIR "/stand_ins/my_integrator.so";

struct Folder : TemporaryFolder {
    Folder() { write_file(file("scene.xml"), ball_under_sky(24, 16)); }
    RunResult run(std::vector<std::string> arguments, const std::string& plugins = "") const {
        return run_mote(*this, std::move(arguments), [&] {
            if (!plugins.empty()) ::setenv("MOTE_PLUGINS", plugins.c_str(), 1);
        });
    }
    /// A picture of four passes by the plugin.
    RunResult render(const std::string& output, std::vector<std::string> more) const {
        std::vector<std::string> all = {"render",   "scene.xml", "--integrator", "my_ambient_occlusion",
                                        "--plugin", plugin,      "-o",           output};
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    }
    auto channels(const std::string& name) const { return mote::core::read_exr(file(name)).channels; }
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("A plugin's integrator has the same bits on one thread and many, and in parts",
          "[command][plugins]") {
    const Folder folder;
    const RunResult r = folder.render("whole.exr", {"--passes", "4", "-t", "1", "--stats", "whole.json"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    CHECK(contains(read_file(folder.file("whole.json")), "\"my_ambient_occlusion\""));
    const auto whole = folder.channels("whole.exr");
    CHECK(mote::core::read_exr(folder.file("whole.exr")).rgb("indirect_ambient").size() == 24 * 16);
    REQUIRE(folder.render("many.exr", {"--passes", "4", "-t", "2"}).exit_code == 0);
    CHECK(folder.channels("many.exr") == whole);

    REQUIRE(folder.render("a.film", {"--pass-range", "0:3"}).exit_code == 0);
    REQUIRE(folder.render("b.film", {"--pass-range", "3:4"}).exit_code == 0);
    const RunResult merged = folder.run({"merge", "a.film", "b.film", "-o", "merged.exr"});
    INFO(merged.err);
    REQUIRE(merged.exit_code == 0);
    CHECK(folder.channels("merged.exr") == whole);
}

TEST_CASE("MOTE_PLUGINS loads plugins for every command", "[command][plugins]") {
    const Folder folder;
    const auto plan =
        folder.run({"plan", "scene.xml", "--integrator", "my_ambient_occlusion"}, ":" + plugin + ":");
    INFO(plan.err);
    CHECK(plan.exit_code == 0);
    CHECK(contains(plan.out, "ambient occlusion"));
    CHECK(contains(folder.run({"formats"}, plugin).out, "my_ambient_occlusion"));
    CHECK(contains(folder.run({"formats", "--plugin", plugin}).out, "my_ambient_occlusion"));
    CHECK_FALSE(contains(folder.run({"formats"}).out, "my_ambient_occlusion"));

    const auto without = folder.run({"plan", "scene.xml", "--integrator", "my_ambient_occlusion"});
    CHECK(without.exit_code == 1);
    CHECK(contains(without.err, "my_ambient_occlusion"));
    const auto gone = folder.run({"plan", "scene.xml"}, plugin + ":gone.so");
    CHECK(gone.exit_code == 1);
    CHECK(contains(gone.err, "gone.so: there is no such plugin"));
}

TEST_CASE("A trade compares a plugin's integrator", "[command][plugins]") {
    const Folder folder;
    write_file(folder.file("methods.json"), R"({"passes": 2, "seeds": 1, "methods": [
        {"name": "path", "integrator": "path"},
        {"name": "mine", "integrator": "my_ambient_occlusion", "settings": {"distance": 0.5}}]})");
    const RunResult r = folder.run({"trade", "scene.xml", "--methods", "methods.json", "--plugin", plugin,
                                    "-o", "out", "--resolve", "1", "--quiet"});
    INFO(r.err);
    CHECK(r.exit_code == 0);
    CHECK(contains(read_file(folder.file("out/trade.csv")), "mine"));
}

TEST_CASE("A checkpoint of another plugin is not continued", "[command][plugins]") {
    const Folder folder;
    const std::string own = folder.file("own.so");
    std::filesystem::copy_file(plugin, own);
    std::vector<std::string> arguments = {
        "render", "scene.xml", "--integrator", "my_ambient_occlusion", "--plugin", own, "-o",
        "o.exr",  "--passes",  "1000000",      "--checkpoint-every",   "0"};
    MoteProcess process(folder, arguments);
    REQUIRE(wait_for_file(process, folder.file("o.exr.checkpoint")));
    process.send(SIGINT);
    CHECK(process.wait().exit_code == 130);
    // Bytes behind the last section change nothing but the file.
    std::ofstream(own, std::ios::binary | std::ios::app) << "another version";
    arguments.push_back("--resume");
    const RunResult r = folder.run(arguments);
    CHECK(r.exit_code == 1);
    CHECK(contains(r.err, "checkpoint"));
}
