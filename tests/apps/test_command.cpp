// The command line: exit codes, one-line errors, outputs, interruption and resume.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
namespace fs = std::filesystem;

namespace {

// A lit floor. $size keeps most renders tiny and lets others take their time.
const char* const scene_text = R"(<scene version="3.0.0">
    <default name="size" value="16"/>
    <integrator type="path"><integer name="max_depth" value="3"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="50"/>
        <transform name="to_world">
            <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/>
        </transform>
        <film type="hdrfilm">
            <integer name="width" value="$size"/>
            <integer name="height" value="$size"/>
            <rfilter type="box"/>
        </film>
        <sampler type="independent"><integer name="sample_count" value="4"/></sampler>
    </sensor>
    <shape type="rectangle">
        <bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.4, 0.3"/></bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world"><scale value="0.2"/><translate z="2" x="1.5"/>
        </transform>
        <emitter type="area"><rgb name="radiance" value="10, 10, 10"/></emitter>
    </shape>
    <emitter type="point">
        <point name="position" x="0" y="1" z="3"/>
        <rgb name="intensity" value="2, 2, 2"/>
    </emitter>
</scene>
)";

struct SceneFolder : TemporaryFolder {
    SceneFolder() { write_file(file("scene.xml"), scene_text); }
    bool has(const std::string& name) const { return fs::exists(file(name)); }
};

std::size_t lines(const std::string& text) { return std::size_t(std::count(text.begin(), text.end(), '\n')); }

// Exactly one line on stderr that starts with "mote: ", and nothing on stdout.
void check_error(const RunResult& result, int exit_code, const std::string& part) {
    INFO(result.err);
    CHECK(result.exit_code == exit_code);
    CHECK(lines(result.err) == 1);
    CHECK(result.err.rfind("mote: ", 0) == 0);
    CHECK(result.err.find(part) != std::string::npos);
    CHECK(result.out.empty());
}

bool same_pixels(const std::string& a, const std::string& b) {
    const auto first = mote::core::read_exr(a), second = mote::core::read_exr(b);
    return first.names == second.names && first.channels == second.channels;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("Help and version end with 0, on stdout", "[command]") {
    const SceneFolder folder;
    const RunResult help = run_mote(folder, {"--help"});
    CHECK(help.exit_code == 0);
    for (const char* word : {"render", "plan", "info", "convert", "formats"}) CHECK(contains(help.out, word));
    CHECK(contains(run_mote(folder, {"render", "--help"}).out, "--checkpoint-every"));
    CHECK(contains(run_mote(folder, {"--version"}).out, "mote "));
}

TEST_CASE("Wrong usage ends with 2 and one line", "[command]") {
    const SceneFolder folder;
    check_error(run_mote(folder, {}), 2, "subcommand");
    check_error(run_mote(folder, {"rendr"}), 2, "mote --help");
    check_error(run_mote(folder, {"render"}), 2, "SCENE");
    check_error(run_mote(folder, {"render", "scene.xml", "--nonsense"}), 2, "--nonsense");
    check_error(run_mote(folder, {"render", "scene.xml", "extra.xml"}), 2, "extra.xml");
    check_error(run_mote(folder, {"render", "scene.xml", "--passes", "0"}), 2, "--passes");
    check_error(run_mote(folder, {"render", "scene.xml", "--passes", "many"}), 2, "--passes");
    check_error(run_mote(folder, {"render", "scene.xml", "--time", "-1"}), 2, "--time");
    check_error(run_mote(folder, {"render", "scene.xml", "--noise", "0"}), 2, "--noise");
    check_error(run_mote(folder, {"render", "scene.xml", "--error", "0"}), 2, "--error");
    check_error(run_mote(folder, {"render", "scene.xml", "--threads", "-2"}), 2, "--threads");
    check_error(run_mote(folder, {"render", "scene.xml", "--seed", "-2"}), 2, "--seed");
    check_error(run_mote(folder, {"render", "scene.xml", "-D", "size"}), 2, "name=value");
    check_error(run_mote(folder, {"render", "scene.xml", "-o", "a.gif"}), 2, ".exr");
    check_error(run_mote(folder, {"convert", "a.exr", "b.gif"}), 2, "b.gif");
    CHECK_FALSE(folder.has("scene.exr"));
}

TEST_CASE("Bad input ends with 1, one line that names the file, and no output", "[command]") {
    const SceneFolder folder;
    check_error(run_mote(folder, {"render", "missing.xml"}), 1, "missing.xml");
    write_file(folder.file("cut.xml"), std::string(scene_text).substr(0, 300));
    check_error(run_mote(folder, {"render", "cut.xml"}), 1, "cut.xml:");
    std::string text = scene_text;
    text.replace(text.find("max_depth"), 9, "maxdepht_");
    write_file(folder.file("typo.xml"), text);
    check_error(run_mote(folder, {"render", "typo.xml"}), 1, "typo.xml:3: ");
    check_error(run_mote(folder, {"render", "typo.xml"}), 1, "max_depth");
    check_error(run_mote(folder, {"render", "scene.xml", "-D", "siez=4"}), 1, "siez");
    check_error(run_mote(folder, {"render", "scene.xml", "--integrator", "pathh"}), 1, "path");
    check_error(run_mote(folder, {"plan", "missing.xml"}), 1, "missing.xml");
    check_error(run_mote(folder, {"info", "missing.vdb"}), 1, "missing.vdb");
    check_error(run_mote(folder, {"convert", "missing.exr", "a.png"}), 1, "missing.exr");
    check_error(run_mote(folder, {"render", "scene.xml", "-o", "no/such/a.exr"}), 1, "no/such/a.exr");
    check_error(run_mote(folder, {"render", "scene.xml", "-o", "scene.xml/a.exr"}), 1, "scene.xml/a.exr");
    check_error(run_mote(folder, {"render", "scene.xml", "--stats", "no/such.json"}), 1, "no/such.json");
    for (const auto& entry : fs::directory_iterator(folder.path())) {
        CHECK(entry.path().extension() != ".exr");
        CHECK(entry.path().extension() != ".png");
    }
}

TEST_CASE("A render writes EXR, PNG and statistics, and leaves nothing else", "[command]") {
    const SceneFolder folder;
    const RunResult r = run_mote(folder, {"render", "scene.xml", "--passes", "3", "--seed", "5", "--stats",
                                          "stats.json", "-t", "1", "-D", "size=20"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    CHECK(r.out == "scene.exr\nscene.png\n");
    CHECK(folder.size() == 6);                    // scene, picture, preview, statistics, two logs
    CHECK(contains(r.err, "pass 3/3") == false);  // so short a render needs no line in a log

    const auto image = mote::core::read_exr(folder.file("scene.exr"));
    CHECK(image.width == 20);
    CHECK(image.rgb("").size() == 400);
    CHECK(image.metadata.at("seed") == "5");
    CHECK(image.metadata.at("passes") == "3");
    CHECK(contains(image.metadata.at("commandLine"), "--seed 5"));
    CHECK(image.metadata.at("sceneHash").size() == 16);
    CHECK_FALSE(image.metadata.at("gitHash").empty());
    // The camera stands at z = 4 and looks along -z: the origin lies 4 ahead of it.
    CHECK(image.metadata.at("worldToCamera").find(" 4 1") != std::string::npos);
    double sum = 0.0;
    for (const auto& p : image.rgb("")) sum += p.x;
    CHECK(sum > 0.0);

    const auto json = nlohmann::json::parse(read_file(folder.file("stats.json")));
    CHECK(json["passes"] == 3);
    CHECK(json["seed"] == 5);
    CHECK(json["threads"] == 1);
    CHECK(json["integrator"] == "path");
    CHECK(json["peak_memory_bytes"].get<double>() > 1e6);
    CHECK(json["noise"].get<double>() > 0.0);
    CHECK(json["non_finite_samples"] == 0);
    CHECK(json["clamped_samples"] == 0);
    for (const char* key : {"load", "build", "render", "finish", "total"})
        CHECK(json["seconds"].contains(key));
    CHECK(json["rays"].is_object());
    CHECK(json["plan"]["runs"].size() > 0);
    CHECK(mote::core::read_bitmap(folder.file("scene.png"), false).width == 20);
}

TEST_CASE("The total of seconds counts no step twice", "[command]") {
    const SceneFolder folder;
    const RunResult r = run_mote(folder, {"render", "scene.xml", "--integrator", "mote_layers", "--passes",
                                          "2", "--quiet", "-o", "t.exr", "--stats", "t.json"});
    REQUIRE(r.exit_code == 0);
    const auto seconds = nlohmann::json::parse(read_file(folder.file("t.json")))["seconds"];
    REQUIRE(seconds.contains("filter"));  // a part of "finish"
    double steps = 0.0;
    for (const char* step : {"load", "build", "render", "finish", "write"})
        steps += seconds[step].get<double>();
    CHECK(seconds["total"].get<double>() == Approx(steps));
}

TEST_CASE("Quiet renders say nothing", "[command]") {
    const SceneFolder folder;
    const RunResult r = run_mote(folder, {"render", "scene.xml", "--passes", "1", "--quiet", "-o", "q.exr"});
    CHECK(r.exit_code == 0);
    CHECK(r.out.empty());
    CHECK(r.err.empty());
    CHECK(folder.has("q.exr"));
    CHECK(folder.has("q.png"));
}

TEST_CASE("The same seed gives the same bits on one thread and on two", "[command]") {
    const SceneFolder folder;
    run_mote(folder, {"render", "scene.xml", "--passes", "20", "-t", "1", "-o", "one.exr"});
    run_mote(folder, {"render", "scene.xml", "--passes", "20", "-t", "2", "-o", "two.exr"});
    run_mote(folder, {"render", "scene.xml", "--passes", "20", "--seed", "1", "-o", "other.exr"});
    CHECK(same_pixels(folder.file("one.exr"), folder.file("two.exr")));
    CHECK_FALSE(same_pixels(folder.file("one.exr"), folder.file("other.exr")));
}

TEST_CASE("Ctrl-C saves the picture so far, and --resume gives the bits of one run",
          "[command][checkpoint]") {
    const SceneFolder folder;
    // Large enough that many passes take minutes; the interruption comes after the first checkpoint.
    MoteProcess process(folder, {"render", "scene.xml", "-D", "size=64", "--passes", "1000000", "-o", "a.exr",
                                 "--checkpoint-every", "0"});
    REQUIRE(wait_for_file(process, folder.file("a.exr.checkpoint")));
    process.send(SIGINT);
    const auto requested = std::chrono::steady_clock::now();
    const RunResult cut = process.wait();
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - requested).count();
    INFO(cut.err);
    CHECK(cut.exit_code == 130);
    CHECK(seconds < 20.0);  // at once, unless the system holds it up; its passes would take minutes
    CHECK(contains(cut.err, "--resume"));
    CHECK(contains(cut.err, "a.exr"));
    REQUIRE(folder.has("a.exr"));
    REQUIRE(folder.has("a.exr.checkpoint"));
    const int done = std::stoi(mote::core::read_exr(folder.file("a.exr")).metadata.at("passes"));
    REQUIRE(done >= 1);

    const std::string wanted = std::to_string(done + 5);
    const RunResult resumed = run_mote(
        folder, {"render", "scene.xml", "-D", "size=64", "--passes", wanted, "-o", "a.exr", "--resume"});
    INFO(resumed.err);
    CHECK(resumed.exit_code == 0);
    CHECK_FALSE(folder.has("a.exr.checkpoint"));
    run_mote(folder, {"render", "scene.xml", "-D", "size=64", "--passes", wanted, "-o", "b.exr"});
    CHECK(same_pixels(folder.file("a.exr"), folder.file("b.exr")));
}

TEST_CASE("A killed render continues from its last checkpoint, unless an input has changed",
          "[command][checkpoint]") {
    const SceneFolder folder;
    MoteProcess process(folder, {"render", "scene.xml", "-D", "size=64", "--passes", "1000000", "-o", "a.exr",
                                 "--checkpoint-every", "0"});
    REQUIRE(wait_for_file(process, folder.file("a.exr.checkpoint")));
    process.send(SIGKILL);
    CHECK(process.wait().exit_code == -1);
    CHECK_FALSE(folder.has("a.exr"));
    const std::string checkpoint = read_file(folder.file("a.exr.checkpoint"));

    const auto resume = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"render",   "scene.xml", "-o",  "a.exr",
                                              "--resume", "--time",    "0.01"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_mote(folder, arguments);
    };
    check_error(resume({"-D", "size=64", "--seed", "1"}), 1, "a.exr.checkpoint: ");
    check_error(resume({"-D", "size=65"}), 1, "another render");
    std::string damaged = checkpoint;
    damaged[damaged.size() / 2] = char(damaged[damaged.size() / 2] ^ 4);
    write_file(folder.file("a.exr.checkpoint"), damaged);
    check_error(resume({"-D", "size=64"}), 1, "damaged");
    write_file(folder.file("a.exr.checkpoint"), checkpoint);
    std::string changed = scene_text;
    changed.replace(changed.find("2, 2, 2"), 7, "2, 2, 3");
    write_file(folder.file("scene.xml"), changed);
    check_error(resume({"-D", "size=64"}), 1, "changed");
    CHECK_FALSE(folder.has("a.exr"));
    CHECK(read_file(folder.file("a.exr.checkpoint")) == checkpoint);
    write_file(folder.file("scene.xml"), scene_text);
    CHECK(resume({"-D", "size=64"}).exit_code == 0);
    CHECK(folder.has("a.exr"));
}

TEST_CASE("plan, info and formats describe on stdout", "[command]") {
    const SceneFolder folder;
    const RunResult plan = run_mote(folder, {"plan", "scene.xml"});
    CHECK(plan.exit_code == 0);
    CHECK(contains(plan.out, "integrator: path"));
    CHECK(contains(run_mote(folder, {"plan", "scene.xml", "--integrator", "volpath"}).out, "volpath"));
    const RunResult info = run_mote(folder, {"info", "scene.xml"});
    CHECK(info.exit_code == 0);
    CHECK(contains(info.out, "16 x 16"));
    write_file(folder.file("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(contains(run_mote(folder, {"info", "m.obj"}).out, "triangles   1"));
    const RunResult formats = run_mote(folder, {"formats"});
    CHECK(formats.exit_code == 0);
    for (const char* type : {"diffuse", "hdrfilm", "path", "homogeneous", "envmap"})
        CHECK(contains(formats.out, type));
}

TEST_CASE("-D reaches objects that are nested in each other", "[command]") {
    // The outer compensation keeps its name when there is one inside it; the inner one has that of its
    // parameter.
    const RunResult plan =
        run_mote(SceneFolder(),
                 {"plan", "scene.xml", "--integrator", "mote_vpl", "-D",
                  "integrator.compensation=screen_space", "-D", "integrator.compensation.media=approximate",
                  "-D", "integrator.compensation.steps=5", "-D", "integrator.compensation.media.depth=3"});
    CHECK(plan.err.empty());
    CHECK(contains(plan.out, "5 step(s), on surfaces"));
    CHECK(contains(run_mote(SceneFolder(),
                            {"plan", "scene.xml", "--integrator", "mote_vpl", "-D",
                             "integrator.compensation=exact", "-D", "integrator.compensation.medium.depth=3"})
                       .err,
                   "no element 'medium'"));
}

TEST_CASE("Peak memory is that of the command, not of the program that starts it", "[command]") {
    const SceneFolder folder;
    const std::vector<char> held(1u << 30, 1);
    REQUIRE(run_mote(folder, {"render", "scene.xml", "--passes", "1", "--stats", "s.json"}).exit_code == 0);
    const double peak = nlohmann::json::parse(read_file(folder.file("s.json"))).at("peak_memory_bytes");
    CHECK(peak > 1e6);
    CHECK(peak < double(held.size()));
}

TEST_CASE("The preview adapts, --exposure fixes it, and the PNG says which", "[command][exposure]") {
    const SceneFolder folder;
    const RunResult r = run_mote(folder, {"render", "scene.xml", "--passes", "2"});
    REQUIRE(r.exit_code == 0);
    // The log states the number that gives the same picture again.
    const auto at = r.err.find("scene.png: exposure ");
    REQUIRE(at != std::string::npos);
    const std::string stops = r.err.substr(at + 20, r.err.find(' ', at + 20) - at - 20);
    CHECK(contains(r.err, stops + " stops, adapted to the key value 0.18 (--exposure fixes it)"));
    const std::string adapted = read_file(folder.file("scene.png"));
    CHECK(contains(adapted, "Exposure"));
    CHECK(contains(adapted, stops + " stops, adapted to the key value 0.18"));
    const auto pixels = [&](const std::string& name) {
        return mote::core::read_bitmap(folder.file(name), false).pixels;
    };
    const RunResult fixed =
        run_mote(folder, {"render", "scene.xml", "--passes", "2", "-o", "f.exr", "--exposure", stops});
    REQUIRE(fixed.exit_code == 0);
    CHECK(contains(read_file(folder.file("f.png")), stops + " stops, fixed"));
    CHECK(contains(fixed.err, stops + " stops, fixed"));
    CHECK(pixels("f.png") == pixels("scene.png"));
    REQUIRE(run_mote(folder, {"convert", "scene.exr", "a.png", "--exposure", stops, "--tone", "filmic"})
                .exit_code == 0);
    CHECK(pixels("a.png") == pixels("scene.png"));
    REQUIRE(run_mote(folder, {"render", "scene.xml", "--passes", "2", "-o", "d.exr", "--exposure", "-8"})
                .exit_code == 0);
    CHECK(pixels("d.png") != pixels("scene.png"));
}

TEST_CASE("All that states the noise states the same", "[command][noise]") {
    const SceneFolder folder;
    const RunResult r = run_mote(folder, {"render", "scene.xml", "--noise", "0.1", "--stats", "s.json"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    const double noise = nlohmann::json::parse(read_file(folder.file("s.json"))).at("noise");
    CHECK(noise <= 0.1);
    CHECK(noise > 0.05);
    const auto image = mote::core::read_exr(folder.file("scene.exr"));
    CHECK(std::stod(image.metadata.at("noise")) == Approx(noise).epsilon(1e-5));
    for (const auto& [key, value] : image.metadata)
        CHECK((key == "noise" || (!contains(key, "Error") && !contains(key, "oise"))));
}

TEST_CASE("convert takes exposure and layers into account", "[command]") {
    const SceneFolder folder;
    REQUIRE(run_mote(folder, {"render", "scene.xml", "--passes", "2"}).exit_code == 0);
    REQUIRE(run_mote(folder, {"convert", "scene.exr", "up.exr", "--exposure", "1"}).exit_code == 0);
    const auto before = mote::core::read_exr(folder.file("scene.exr")).rgb("");
    const auto after = mote::core::read_exr(folder.file("up.exr")).rgb("");
    for (std::size_t i = 0; i < before.size(); ++i) CHECK(after[i] == 2.0f * before[i]);
    CHECK(contains(run_mote(folder, {"info", "scene.exr"}).out, "Variance.R"));
    check_error(run_mote(folder, {"convert", "scene.exr", "a.png", "--layer", "nothing"}), 1, "scene.exr");
}
