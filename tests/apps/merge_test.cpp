// Ranges of passes by several runs of the command, merged: the picture of one run, to the bit; and what is
// refused.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/formats/pictures/image_file.h"
#include "core/render/partial_film.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using namespace mote::core;

namespace {

struct Folder : TemporaryFolder {
    Folder() {
        write_file(file("scene.xml"), R"(<scene version="3.0.0"><default name="grey" value="0.5"/>
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="24"/>
            <integer name="height" value="20"/></film><transform name="to_world">
            <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
            <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="$grey"/></bsdf></shape>
            <shape type="rectangle"><transform name="to_world"><scale value="4"/><rotate x="1" angle="-90"/>
            <translate y="-1"/></transform></shape><emitter type="constant"/><integrator type="mote_layers">
            <integrator type="path" name="emission, direct"/><integrator type="path" name="indirect"/>
            </integrator></scene>)");
    }
    RunResult run(std::vector<std::string> arguments) const { return run_mote(*this, std::move(arguments)); }
    RunResult render(const std::string& range, const std::string& film,
                     std::vector<std::string> more = {}) const {
        std::vector<std::string> all = {"render", "scene.xml", "--quiet", "--pass-range", range, "-o", film};
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    }
    auto channels(const std::string& name) const {
        const auto image = read_exr(file(name));
        return std::pair(image.names, image.channels);
    }
};

const std::vector<std::string> layers = {"-D", "integrator.shares=1, 2", "--auxiliary"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

bool says(const RunResult& result, const std::string& text) {
    UNSCOPED_INFO(result.err);
    return result.exit_code == 1 && result.err.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("three ranges merged, in any order and in two steps, are the picture of one run", "[merge]") {
    const Folder folder;
    for (const bool interval : {false, true}) {
        CAPTURE(interval);
        const auto how = interval ? layers + std::vector<std::string>{"-D", "film.interval=true"} : layers;
        REQUIRE(folder
                    .run(std::vector<std::string>{"render", "scene.xml", "--quiet", "--passes", "14", "-o",
                                                  "one.exr"} +
                         how)
                    .exit_code == 0);
        REQUIRE(folder.render("0:1", "a.film", how).exit_code == 0);
        REQUIRE(folder.render("1:5", "b.film", how).exit_code == 0);
        REQUIRE(folder.render("5:14", "c.film", how + std::vector<std::string>{"-t", "1"}).exit_code == 0);
        REQUIRE(
            folder.run({"merge", "c.film", "a.film", "b.film", "-o", "m.exr", "--stats", "m.json", "--quiet"})
                .exit_code == 0);
        CHECK((folder.channels("m.exr") == folder.channels("one.exr")));
        const auto metadata = read_exr_metadata(folder.file("m.exr"));
        CHECK(metadata.at("passes") == "14");
        CHECK(metadata.contains("errorInterval") == interval);
        if (interval)
            CHECK(metadata.at("errorInterval") ==
                  read_exr_metadata(folder.file("one.exr")).at("errorInterval"));
        CHECK(metadata.at("noise") == read_exr_metadata(folder.file("one.exr")).at("noise"));
        REQUIRE(folder.run({"merge", "c.film", "b.film", "-o", "bc.film"}).exit_code == 0);
        REQUIRE(folder.run({"merge", "a.film", "bc.film", "-o", "two.exr", "--quiet"}).exit_code == 0);
        CHECK((folder.channels("two.exr") == folder.channels("one.exr")));
        CHECK(read_exr_metadata(folder.file("two.exr")).at("sceneHash") ==
              read_exr_metadata(folder.file("one.exr")).at("sceneHash"));
    }
}

TEST_CASE("counts of merged films add up", "[merge]") {
    const Folder folder;
    const std::vector<std::string> how = {"--integrator", "mote_vpl", "-D", "integrator.paths=20"};
    const auto stats = [&](const std::string& name) {
        return nlohmann::json::parse(read_file(folder.file(name)));
    };
    REQUIRE(folder
                .run(std::vector<std::string>{"render", "scene.xml", "--quiet", "--passes", "5", "-o",
                                              "one.exr", "--stats", "one.json"} +
                     how)
                .exit_code == 0);
    REQUIRE(folder.render("0:2", "a.film", how).exit_code == 0);
    REQUIRE(folder.render("2:5", "b.film", how).exit_code == 0);
    REQUIRE(
        folder.run({"merge", "a.film", "b.film", "-o", "m.exr", "--stats", "m.json", "--quiet"}).exit_code ==
        0);
    const auto one = stats("one.json"), merged = stats("m.json");
    for (const char* key : {"rays", "lookups", "vpls", "noise", "passes"})
        CHECK(one.at(key) == merged.at(key));
    CHECK(one.at("rays").at("closest").get<double>() > 0.0);
    CHECK(one.at("values").at("light_paths") == merged.at("values").at("light_paths"));
}

TEST_CASE("what does not belong together is not merged, and the reason is said", "[merge]") {
    const Folder folder;
    const std::vector<std::string> path = {"--integrator", "path"};
    REQUIRE(folder.render("0:2", "a.film", path).exit_code == 0);
    const auto merge = [&](const std::string& other) {
        return folder.run({"merge", "a.film", other, "-o", "m.exr", "--quiet"});
    };
    REQUIRE(folder.render("3:5", "gap.film", path).exit_code == 0);
    CHECK(says(merge("gap.film"), "before passes 3 to 4 of 'gap.film' pass 2 is missing"));
    REQUIRE(folder.render("1:5", "twice.film", path).exit_code == 0);
    CHECK(says(merge("twice.film"), "both hold pass 1"));
    REQUIRE(folder.render("2:5", "b.film", path + std::vector<std::string>{"--seed", "7"}).exit_code == 0);
    CHECK(says(merge("b.film"), "seeds differ, '7' and '0'"));
    REQUIRE(folder.render("2:5", "b.film", path + std::vector<std::string>{"-D", "grey=0.4"}).exit_code == 0);
    CHECK(says(merge("b.film"), "definitions (-D) differ"));
    REQUIRE(folder.render("2:5", "b.film", {"--integrator", "volpath"}).exit_code == 0);
    CHECK(says(merge("b.film"), "integrators differ, 'volpath' and 'path'"));
    CHECK(says(folder.run({"merge", "gap.film", "-o", "m.exr"}), "a picture begins with pass 0"));

    std::string bytes = read_file(folder.file("a.film"));
    write_file(folder.file("cut.film"), bytes.substr(0, bytes.size() / 2));
    CHECK(says(merge("cut.film"), "cut.film: this file is damaged"));
    bytes[bytes.size() / 2] ^= 4;
    write_file(folder.file("bent.film"), bytes);
    CHECK(says(merge("bent.film"), "checksum"));
    CHECK(says(merge("scene.xml"), "not a partial film of mote"));
    // An input of the render that has changed since, though neither its name nor the command line has.
    std::string scene = read_file(folder.file("scene.xml"));
    write_file(folder.file("scene.xml"), scene + "\n");
    CHECK(says(folder.run({"merge", "a.film", "-o", "m.exr", "--quiet"}),
               "are of another one: the scene, a file"));
    REQUIRE(folder.render("2:5", "b.film", path).exit_code == 0);
    CHECK(says(merge("b.film"), "contents of the scene or of a file that it names differ"));
    CHECK_FALSE(std::filesystem::exists(folder.file("m.exr")));

    CHECK(folder.render("3:3", "x.film", path).exit_code == 2);
    CHECK(folder.render("3:4", "x.exr", path).exit_code == 2);
    CHECK(folder.render("3:4", "x.film", {"--noise", "0.1"}).exit_code == 2);
    CHECK(says(folder.render("3:4", "x.film"), "integrator.shares with 2 numbers"));
}

TEST_CASE("a range that was interrupted continues to the same film", "[merge]") {
    const Folder folder;
    const std::vector<std::string> long_one = {"--integrator", "path", "--checkpoint-every", "0"};
    REQUIRE(folder.render("40:300", "a.film", long_one).exit_code == 0);
    MoteProcess process(
        folder,
        std::vector<std::string>{"render", "scene.xml", "--pass-range", "40:300", "-o", "b.film"} + long_one);
    REQUIRE(wait_for_file(process, folder.file("b.film.checkpoint")));
    process.send(SIGINT);
    const RunResult cut = process.wait();
    INFO(cut.err);
    if (cut.exit_code != 0) {  // else it was quicker than the signal
        CHECK(cut.exit_code == 128 + SIGINT);
        CHECK(cut.err.find("--resume") != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(folder.file("b.film")));
        // The checkpoint of one range is not that of another.
        std::filesystem::copy(folder.file("b.film.checkpoint"), folder.file("c.film.checkpoint"));
        CHECK(says(folder.render("41:301", "c.film", long_one + std::vector<std::string>{"--resume"}),
                   "holds passes from 40 on, not from 41"));
        REQUIRE(
            folder.render("40:300", "b.film", long_one + std::vector<std::string>{"--resume"}).exit_code ==
            0);
    }
    const auto film = [&](const std::string& name) { return read_partial_film(folder.file(name)).film; };
    CHECK((film("a.film").serialize() == film("b.film").serialize()));
    CHECK_FALSE(std::filesystem::exists(folder.file("b.film.checkpoint")));
}
