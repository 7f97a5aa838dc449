// Careless and hostile command lines: inputs as outputs, malformed numbers, pipes as files, JSON without end.
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using namespace mote::core;
namespace fs = std::filesystem;

namespace {

// A wall with a picture on it, under a picture of the sky.
std::string scene_text(const std::string& light = "1, 1, 1") {
    return R"(<scene version="3.0.0">
    <integrator type="path"><integer name="max_depth" value="2"/></integrator>
    <sensor type="perspective">
        <transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film>
        <sampler type="independent"><integer name="sample_count" value="2"/></sampler>
    </sensor>
    <shape type="rectangle"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
        <string name="filename" value="o2.png"/></texture></bsdf></shape>
    <emitter type="envmap"><string name="filename" value="sky.exr"/></emitter>
    <emitter type="point"><point name="position" x="0" y="1" z="3"/><rgb name="intensity" value=")" +
           light + R"("/></emitter>
</scene>)";
}

struct InputFolder : TemporaryFolder {
    InputFolder() {
        write_file(file("scene.xml"), scene_text());
        write_png(file("o2.png"), 2, 2, std::vector<Rgb>(4, Rgb(0.5f)));
        write_grey("sky.exr", 0.5f);
    }
    void write_grey(const std::string& name, float value) const {
        ImageChannels image;
        image.width = 4, image.height = 2;
        image.add_rgb("", std::vector<Rgb>(8, Rgb(value)));
        write_exr(file(name), image);
    }
    /// The bytes of all files but the logs, by name.
    std::map<std::string, std::string> contents() const {
        std::map<std::string, std::string> all;
        for (const auto& entry : fs::recursive_directory_iterator(path()))
            if (entry.is_regular_file() && entry.path().extension() != ".txt")
                all[entry.path().string()] = read_file(entry.path().string());
        return all;
    }
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// Refused with one line that holds `part`, and every file is as it was.
void check_refused(const InputFolder& folder, const std::vector<std::string>& arguments,
                   const std::string& part, int exit_code = 1) {
    const auto before = folder.contents();
    const RunResult run = run_mote(folder, arguments);
    std::string command;
    for (const std::string& a : arguments) command += a + " ";
    INFO(command << "\n" << run.err);
    CHECK(run.exit_code == exit_code);
    CHECK(contains(run.err, part));
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
    CHECK(folder.contents() == before);
}

}  // namespace

TEST_CASE("A render does not overwrite what it reads", "[command][hostile]") {
    const InputFolder folder;
    check_refused(folder, {"render", "scene.xml", "-o", "o2.exr"}, "the preview would replace");
    check_refused(folder, {"render", "scene.xml", "-o", "sky.exr"}, "the picture would replace");
    check_refused(folder, {"render", "scene.xml", "--stats", "scene.xml"}, "the statistics would replace");
    check_refused(folder, {"render", "scene.xml", "-o", "a.exr", "--stats", "a.exr"},
                  "cannot be written twice");
    check_refused(folder, {"render", "scene.xml", "-o", "a.exr", "--stats", "a.png"},
                  "cannot be written twice");
    check_refused(folder, {"render", "scene.xml", "-o", "a.exr", "--stats", "./a.exr.checkpoint"},
                  "cannot be written twice");
}

TEST_CASE("Files are distinguished by what they are, not by their names", "[command][hostile]") {
    const InputFolder folder;
    fs::create_symlink("sky.exr", folder.file("link.exr"));
    fs::create_hard_link(folder.file("sky.exr"), folder.file("hard.exr"));
    fs::create_directory(folder.file("sub"));
    fs::create_directory_symlink(".", folder.file("here"));
    fs::create_symlink("not_yet.exr", folder.file("dangling.exr"));
    for (const char* name : {"link.exr", "hard.exr", "./sky.exr", "sub/../sky.exr", "here/sky.exr"})
        check_refused(folder, {"render", "scene.xml", "-o", name}, "would replace");
    check_refused(folder, {"render", "scene.xml", "-o", "dangling.exr", "--stats", "here/not_yet.exr"},
                  "cannot be written twice");
    // Devices may be named twice, and a picture of an earlier render is no input.
    REQUIRE(run_mote(folder, {"render", "scene.xml", "-o", "a.exr", "--stats", "/dev/null"}).exit_code == 0);
    CHECK(run_mote(folder, {"render", "scene.xml", "-o", "a.exr", "--stats", "/dev/null"}).exit_code == 0);
}

TEST_CASE("convert, compare, ssbc, export and trade do not overwrite what they read", "[command][hostile]") {
    const InputFolder folder;
    folder.write_grey("b.exr", 0.25f);
    check_refused(folder, {"convert", "sky.exr", "./sky.exr"}, "would replace");
    check_refused(folder, {"compare", "o2.png", "o2.png", "--map", "o2.png"}, "would replace");
    check_refused(folder, {"ssbc", "b.exr", "-o", "b.exr", "--bound", "1"}, "would replace");
    check_refused(folder, {"ssbc", "b.exr", "-o", "scene.xml", "--scene", "scene.xml", "--bound", "1"},
                  "would replace");
    check_refused(folder, {"export", "scene.xml", "--to", "mitsuba3", "-o", "."}, "would replace");
    write_file(folder.file("methods.json"),
               R"({"passes": 1, "seeds": 1, "methods": [{"name": "sky", "integrator": "path"}]})");
    check_refused(folder, {"trade", "scene.xml", "--make-reference", "o2.exr"}, "its preview would replace");
    fs::create_directory(folder.file("out"));
    folder.write_grey("out/reference.exr", 1.0f);
    check_refused(folder,
                  {"trade", "scene.xml", "--reference", "sky.exr", "--trust-reference", "--methods",
                   "methods.json", "-o", "."},
                  "sky.exr");
}

TEST_CASE("Numbers that are none, or wrap, are refused in few words", "[command][hostile]") {
    const InputFolder folder;
    for (const char* option : {"--time", "--noise", "--checkpoint-every"})
        for (const char* value : {"nan", "inf", "1e999"})
            check_refused(folder, {"render", "scene.xml", option, value}, option, 2);
    check_refused(folder, {"render", "scene.xml", "--seed", "18446744073709551616"}, "--seed", 2);
    check_refused(folder, {"render", "scene.xml", "--passes", "4294967297"}, "--passes", 2);
    const RunResult zero = run_mote(folder, {"render", "scene.xml", "--time", "0"});
    CHECK(zero.exit_code == 2);
    CHECK(zero.err.size() < 120);
    CHECK(run_mote(folder, {"render", "scene.xml", "-o", "a.exr", "--seed", "18446744073709551615"})
              .exit_code == 0);
    CHECK(read_exr(folder.file("a.exr")).metadata.at("seed") == "18446744073709551615");
}

TEST_CASE("-o may name the preview", "[command]") {
    const InputFolder folder;
    const RunResult run = run_mote(folder, {"render", "scene.xml", "-o", "x.png"});
    CHECK(run.exit_code == 0);
    CHECK(run.out == "x.exr\nx.png\n");
    CHECK(read_bitmap(folder.file("x.png"), false).width == 8);
    CHECK(read_exr(folder.file("x.exr")).width == 8);
    check_refused(folder, {"render", "scene.xml", "-o", "x.jpg"}, "neither .exr nor .png", 2);
}

TEST_CASE("Misspelt commands and options get the nearest word", "[command]") {
    const InputFolder folder;
    check_refused(folder, {"rendr", "scene.xml"}, "did you mean 'render'?", 2);
    check_refused(folder, {"render", "scene.xml", "--pases", "4"}, "did you mean '--passes'?", 2);
    check_refused(folder, {"convert", "sky.exr", "--exposre=2", "a.png"}, "did you mean '--exposure'?", 2);
    check_refused(folder, {"trade", "scene.xml", "--metods", "m.json"}, "did you mean '--methods'?", 2);
}

TEST_CASE("JSON nested without end is refused at once", "[command][hostile]") {
    const InputFolder folder;
    write_file(folder.file("deep.json"),
               R"({"methods": )" + std::string(50000, '[') + std::string(50000, ']') + "}");
    const auto start = std::chrono::steady_clock::now();
    check_refused(folder,
                  {"trade", "scene.xml", "--reference", "sky.exr", "--methods", "deep.json", "-o", "out"},
                  "nested more than 64 deep");
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
    fs::create_directory(folder.file("old"));
    fs::copy_file(folder.file("deep.json"), folder.file("old/trade.json"));
    check_refused(folder, {"trade", "--redraw", "-o", "old"}, "damaged");
}

TEST_CASE("Light too bright for a float's square, or for a half, is counted and said", "[command][hostile]") {
    const InputFolder folder;
    write_file(folder.file("bright.xml"), scene_text("1e30, 1e30, 1e30"));
    const RunResult bright =
        run_mote(folder, {"render", "bright.xml", "-o", "a.exr", "--half", "--stats", "s.json"});
    INFO(bright.err);
    CHECK(bright.exit_code == 0);
    CHECK(contains(bright.err, " pixels is too large for a float"));
    CHECK(contains(bright.err, "values above 65504"));
    const auto json = nlohmann::json::parse(read_file(folder.file("s.json")));
    CHECK(json["warnings"].size() == 2);
    const RunResult plain = run_mote(folder, {"render", "scene.xml", "-o", "a.exr", "--half"});
    CHECK_FALSE(contains(plain.err, "warning"));
    folder.write_grey("large.exr", 1e6f);
    CHECK(contains(run_mote(folder, {"convert", "large.exr", "half.exr", "--half"}).err,
                   "24 values above 65504"));
}

TEST_CASE("Pipes are not waited for, and a full output is noticed", "[command][hostile]") {
    const InputFolder folder;
    for (const char* name : {"a.exr", "a.png", "a.vdb", "a.vol", "a.obj", "a.glb", "a.xml"}) {
        REQUIRE(::mkfifo(folder.file(name).c_str(), 0600) == 0);
        check_refused(folder, {"info", name}, "is a pipe or a device");
    }
    check_refused(folder, {"convert", "a.exr", "b.png"}, "is a pipe or a device");
    check_refused(folder, {"compare", "sky.exr", "a.png"}, "is a pipe or a device");
    MoteProcess full(folder, {"info", "sky.exr"}, "/dev/full");
    const RunResult run = full.wait();
    CHECK(run.exit_code == 1);
    CHECK(contains(run.err, "the standard output cannot be written: No space left"));
}

TEST_CASE("Libraries do not print", "[command][hostile]") {
    const InputFolder folder;
    std::string png = read_file(folder.file("o2.png"));
    png[png.find("IDAT") + 8] = char(png[png.find("IDAT") + 8] ^ 0x55);
    write_file(folder.file("damaged.png"), png);
    check_refused(folder, {"info", "damaged.png"}, "damaged PNG file");
    write_file(folder.file("story.gltf"),
               R"({"asset": {"version": "2.0"}, "scene": ")" + std::string(3000, 'x') + "\"");
    const RunResult story = run_mote(folder, {"info", "story.gltf"});
    CHECK(story.exit_code == 1);
    CHECK(story.err.size() < 300);
}

TEST_CASE("A texture above 1 is named", "[command][hostile]") {
    const InputFolder folder;
    folder.write_grey("bright.exr", 1.5f);
    std::string text = scene_text();
    text.replace(text.find("o2.png"), 6, "bright.exr");
    write_file(folder.file("scene.xml"), text);
    check_refused(folder, {"render", "scene.xml"}, "'bright.exr'");
}

TEST_CASE("What compensation leaves out by choice is one line that names the switches", "[command]") {
    const InputFolder folder;
    std::string text = scene_text();
    text.insert(
        text.find("<emitter type=\"envmap\""),
        R"(<shape type="cube"><bsdf type="null"/><medium name="interior" type="homogeneous"/></shape>)");
    write_file(folder.file("fog.xml"), text);
    const RunResult run = run_mote(folder, {"render", "fog.xml", "--integrator", "mote_vpl", "--passes", "1",
                                            "-D", "integrator.compensation=approximate", "-o", "a.exr"});
    INFO(run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.err.find("note: ") == run.err.rfind("note: "));
    for (const char* part :
         {"note: ", "-D integrator.compensation.depth=-1", "-D integrator.compensation.local_visibility=true",
          "-D integrator.compensation.transmittance=exact"})
        CHECK(contains(run.err, part));
    CHECK_FALSE(contains(run.err, "warning"));
}

TEST_CASE("Light that exceeds single precision at a point names the light with its line",
          "[command][hostile]") {
    const TemporaryFolder folder;
    write_file(folder.file("s.xml"), R"(<scene version="3.0.0"><integrator type="mote_micro_rendering"/>
        <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/>
        <integer name="height" value="8"/></film></sensor>
        <emitter type="point"><point name="position" x="0" y="0" z="0.50007"/><rgb name="intensity" value="1e30"/></emitter>
        <emitter type="point"><point name="position" x="0" y="0" z="0.50006"/><rgb name="intensity" value="1e30"/></emitter>
        <shape type="rectangle"><transform name="to_world"><scale value="1e-6"/><translate z="0.5"/></transform></shape>
        </scene>)");
    const RunResult r = run_mote(folder, {"render", "s.xml", "-o", "a.exr", "--passes", "1", "--quiet"});
    INFO(r.err);
    CHECK(r.exit_code == 1);
    CHECK(r.err.find("mote: s.xml:5: the light that arrives at the surface point (") != std::string::npos);
    CHECK(r.err.find(", 0.5) is not finite in single precision") != std::string::npos);
    CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 1);
}

TEST_CASE("A plan says when a pass marches thousands of lights", "[command][hostile]") {
    const TemporaryFolder folder;
    for (const int count : {10, 1000}) {
        std::string lights;
        for (int i = 0; i < count; ++i) lights += "<emitter type=\"point\"/>";
        write_file(folder.file("s.xml"), R"(<scene version="3.0.0"><sensor type="perspective"/>
            <shape type="sphere"><float name="radius" value="9"/><bsdf type="null"/>
            <medium name="interior" type="homogeneous"/></shape><shape type="sphere"/>)" +
                                             lights + "</scene>");
        for (const char* integrator : {"mote_epipolar", "mote_single_scattering", "mote_layers"}) {
            const RunResult r = run_mote(folder, {"plan", "s.xml", "--integrator", integrator});
            INFO(integrator << " " << count << "\n" << r.out);
            CHECK(r.exit_code == 0);
            const bool marches = count == 1000 && std::string(integrator) != "mote_layers";
            CHECK((r.out.find("million rays") != std::string::npos) == marches);
            if (std::string(integrator) == "mote_epipolar" && marches)
                CHECK(r.out.find("at least 16 million rays, 16384 for each of 1000 lights") !=
                      std::string::npos);
        }
    }
}
