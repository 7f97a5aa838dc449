// Sequences of pictures: mote render scene.xml -D t=0:47 -o frames/####.exr.
#include <fmt/format.h>

#include <csignal>
#include <filesystem>

#include "apps/sequence.h"
#include "apps/subcommands.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/frame_files.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::tests;
namespace fs = std::filesystem;

namespace {

using Values = std::vector<std::string>;

Values values_of(const std::vector<std::string>& defines) {
    const auto parameter = apps::running_parameter(defines);
    return parameter ? parameter->values : Values{};
}

/// A ball that moves, under a lamp whose colour is a list of numbers.
struct Folder : TemporaryFolder {
    Folder() {
        write_file(file("scene.xml"),
                   R"(<scene version="3.0.0"><default name="t" value="0"/><default name="size" value="24"/>
            <default name="colour" value="1, 1, 1"/><integrator type="path"/>
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="$size"/>
            <integer name="height" value="$size"/></film><transform name="to_world">
            <lookat origin="0, 0, 8" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
            <shape type="sphere"><transform name="to_world"><translate x="$t"/><scale value="0.5"/></transform>
            <bsdf type="diffuse"/></shape>
            <emitter type="constant"><rgb name="radiance" value="$colour"/></emitter></scene>)");
        fs::create_directory(file("frames"));
    }
    RunResult mote(const Values& more) const {
        Values all = {"render", "scene.xml", "-t", "1", "--passes", "3", "-D", "colour=1,0.5,0.2"};
        all.insert(all.end(), more.begin(), more.end());
        return run_mote(*this, all);
    }
    std::vector<float> pixels(const std::string& name) const {
        const auto picture = core::read_exr(file(name)).rgb("");
        const auto* first = &picture[0].x;
        return {first, first + 3 * picture.size()};
    }
};

}  // namespace

TEST_CASE("ranges and lists of numbers run, one of them", "[sequence]") {
    CHECK(values_of({"t=0:3"}) == Values{"0", "1", "2", "3"});
    CHECK(values_of({"t=3:0"}) == Values{"3", "2", "1", "0"});
    CHECK(values_of({"a=x", "t=0:0.25:1"}) == Values{"0", "0.25", "0.5", "0.75", "1"});
    CHECK(values_of({"t=0:0.1:0.3"}).size() == 4);  // rounding does not lose the last
    CHECK(values_of({"t=1,5,7"}) == Values{"1", "5", "7"});
    CHECK(values_of({"colour=1,0.5,0.2", "t=4:4"}) == Values{"4"});
    CHECK(values_of({"t=3", "path=C:file", "time=12:30pm"}).empty());
    CHECK(apps::running_parameter({"t=2:4"})->numbers == std::vector<int>{2, 3, 4});
    CHECK(apps::running_parameter({"t=0.5:2.5"})->numbers == std::vector<int>{0, 1, 2});
    for (const std::string wrong : {"t=0:-1:5", "t=0:0:5", "t=1:2:3:4", "t=0:1e-9:1"})
        CHECK_THROWS_AS(apps::running_parameter({wrong}), apps::UsageError);
    CHECK_THROWS_AS(apps::running_parameter({"t=0:4", "s=1:2"}), apps::UsageError);
}

TEST_CASE("the number stands where the # are", "[sequence]") {
    CHECK(core::frame_placeholder("a/####.exr")->with(7) == "a/0007.exr");
    CHECK(core::frame_placeholder("s#1/smoke.##.vdb")->with(123) == "s#1/smoke.123.vdb");
    CHECK_FALSE(core::frame_placeholder("take#1.exr"));
}

TEST_CASE("a frame of a sequence has the bits that it has alone, and noise of its own", "[sequence]") {
    const Folder folder;
    REQUIRE(folder.mote({"-D", "t=0:2", "-o", "frames/####.exr"}).exit_code == 0);
    REQUIRE(folder.mote({"-D", "t=1:1", "-o", "alone.##.exr"}).exit_code == 0);
    CHECK(folder.pixels("frames/0001.exr") == folder.pixels("alone.01.exr"));
    CHECK(folder.pixels("frames/0000.exr") != folder.pixels("frames/0001.exr"));
    CHECK(core::read_exr(folder.file("frames/0002.exr")).metadata.at("seed") == "2");
    CHECK_FALSE(fs::exists(folder.file("frames/0003.exr")));
}

TEST_CASE("a sequence continues with its first unfinished frame", "[sequence]") {
    const Folder folder;
    const Values all = {"-D", "t=0:2", "-o", "frames/####.exr"};
    REQUIRE(folder.mote(all).exit_code == 0);
    const auto first = folder.pixels("frames/0000.exr"), second = folder.pixels("frames/0001.exr");
    const auto written = fs::last_write_time(folder.file("frames/0000.exr"));
    fs::remove(folder.file("frames/0001.exr"));
    write_file(folder.file("frames/0002.exr"), "damaged");
    Values again = all;
    again.emplace_back("--resume");
    const RunResult run = folder.mote(again);
    CHECK(run.exit_code == 0);
    CHECK(run.err.find("0000.exr is finished") != std::string::npos);
    CHECK(fs::last_write_time(folder.file("frames/0000.exr")) == written);
    CHECK(folder.pixels("frames/0001.exr") == second);
    CHECK(folder.pixels("frames/0002.exr").size() == second.size());
    // With more passes, or another colour, they are other pictures.
    again.insert(again.end(), {"-D", "size=20"});
    CHECK(folder.mote(again).err.find("is finished") == std::string::npos);
}

TEST_CASE("files of a sequence take the frame's number", "[sequence]") {
    const Folder folder;
    std::string scene = R"(<scene version="3.0.0"><default name="t" value="0"/><integrator type="path"/>
        <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/>
        </film></sensor><shape type="ply"><string name="filename" value="mesh.###.ply"/></shape>
        <emitter type="constant"><rgb name="radiance" value="$t"/></emitter></scene>)";
    write_file(folder.file("meshes.xml"), scene);
    const auto ply = [](float z) {
        return fmt::format(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "-1 -1 {0}\n1 -1 {0}\n0 1 {0}\n3 0 1 2\n",
            z);
    };
    write_file(folder.file("mesh.004.ply"), ply(4.0f));
    const RunResult there =
        run_mote(folder, {"render", "meshes.xml", "-D", "t=4:4", "-o", "m.##.exr", "--passes", "1"});
    INFO(there.err);
    CHECK(there.exit_code == 0);
    const RunResult missing =
        run_mote(folder, {"render", "meshes.xml", "-D", "t=5:5", "-o", "m.##.exr", "--passes", "1"});
    CHECK(missing.exit_code == 1);
    CHECK(missing.err.find("mesh.005.ply") != std::string::npos);
}

TEST_CASE("frames become a film where there is ffmpeg, and a clear word where there is none", "[sequence]") {
    const Folder folder;
    REQUIRE(folder.mote({"-D", "t=0:1", "-o", "frames/####.exr"}).exit_code == 0);
    const Values convert = {"convert", "frames/####.exr", "film.mp4"};
    const std::string path = ::getenv("PATH") ? ::getenv("PATH") : "";
    ::setenv("PATH", folder.path().c_str(), 1);
    const RunResult without = run_mote(folder, convert);
    CHECK(without.exit_code == 1);
    CHECK(without.err.find("ffmpeg") != std::string::npos);
    // One that keeps what it is given.
    write_file(folder.file("ffmpeg"), "#!/bin/sh\nfor last; do :; done\nexec /bin/cat > \"$last\"\n");
    fs::permissions(folder.file("ffmpeg"), fs::perms::owner_all);
    const RunResult with = run_mote(folder, convert);
    ::setenv("PATH", path.c_str(), 1);
    INFO(with.err);
    CHECK(with.exit_code == 0);
    CHECK(fs::file_size(folder.file("film.mp4")) == 2 * 24 * 24 * 3);
    CHECK(run_mote(folder, {"convert", "frames/0000.exr", "film.mp4"}).exit_code == 2);
    CHECK(run_mote(folder, {"convert", "frames/a####.exr", "film.mp4"}).exit_code == 1);
}
