// Files that the user did not name as outputs are neither written nor removed, whatever they are called.
#include <filesystem>

#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
namespace fs = std::filesystem;

namespace {

/// A scene, and bystanders that say what they are.
struct Folder : TemporaryFolder {
    Folder() {
        write_file(file("scene.xml"), R"(<scene version="3.0.0"><integrator type="path"/>
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/>
            <integer name="height" value="8"/></film><transform name="to_world">
            <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
            <shape type="sphere"><bsdf type="diffuse"/></shape><emitter type="constant"/></scene>)");
        write_file(file("methods.json"),
                   R"({"passes": 2, "methods": [{"name": "one", "integrator": "path"}]})");
    }
    RunResult run(const std::vector<std::string>& arguments) const { return run_mote(*this, arguments); }
    void put(const std::string& name) const { write_file(file(name), "this is " + name); }
    bool holds(const std::string& name) const { return read_file(file(name)) == "this is " + name; }
};

const std::vector<std::string> render_a = {"render", "scene.xml", "-o", "a.exr", "--passes", "1", "-t", "1"};

}  // namespace

TEST_CASE("A render refuses to replace what it was not told to write", "[command][bystanders]") {
    struct Case {
        std::string bystander;
        std::vector<std::string> arguments;
    };
    const Case cases[] = {
        {"a.exr.checkpoint", render_a},
        {"a.png", render_a},
        {"a.exr", {"render", "scene.xml", "-o", "a.png", "--passes", "1"}},
        {"scene.exr", {"render", "scene.xml", "--passes", "1"}},
        {"scene.png", {"render", "scene.xml", "--passes", "1"}},
        {"scene.0-1.film", {"render", "scene.xml", "--pass-range", "0:1"}},
        {"a.film.checkpoint", {"render", "scene.xml", "--pass-range", "0:1", "-o", "a.film"}},
        {"f.0001.png", {"render", "scene.xml", "-o", "f.####.exr", "-D", "film.width=1:2"}},
        {"r.png", {"trade", "scene.xml", "--make-reference", "r.exr", "--resolve", "0.5"}},
        {"r.exr.checkpoint", {"trade", "scene.xml", "--make-reference", "r.exr", "--resolve", "0.5"}}};
    for (const Case& c : cases) {
        const Folder folder;
        folder.put(c.bystander);
        const RunResult r = folder.run(c.arguments);
        INFO(c.bystander << "\n" << r.err);
        CHECK(r.exit_code == 1);
        CHECK(r.err.find(c.bystander) != std::string::npos);  // by name
        CHECK(folder.holds(c.bystander));
    }
}

TEST_CASE("A render leaves bystanders alone, and replaces its own files", "[command][bystanders]") {
    const Folder folder;
    const std::vector<std::string> bystanders = {"a.exr.part", "a.exr.1.part", "a.exr.0-0.part",  "a.film",
                                                 "a.json",     "scene.exr",    "b.exr.checkpoint"};
    for (const std::string& name : bystanders) folder.put(name);
    for (int i = 0; i < 2; ++i) {
        const RunResult r = folder.run(render_a);
        INFO(r.err);
        CHECK(r.exit_code == 0);
    }
    for (const std::string& name : bystanders) CHECK(folder.holds(name));
    CHECK(fs::exists(folder.file("a.png")));
}

TEST_CASE("A trade writes no file that another one has, and --fresh removes its own alone",
          "[command][bystanders][trade]") {
    const std::vector<std::string> trade = {"trade",   "scene.xml", "--methods", "methods.json", "-o", "out",
                                            "--quiet", "-t",        "1"};
    for (const char* name :
         {"trade.csv", "summary.json", "trade.html", "trade.json", "one.exr", "one.json", "reference.exr",
          "automatic_reference.exr", "automatic_reference.png", "automatic_reference.exr.checkpoint"}) {
        const Folder folder;
        fs::create_directory(folder.file("out"));
        folder.put(std::string("out/") + name);
        for (const bool fresh : {false, true}) {
            std::vector<std::string> arguments = trade;
            if (fresh) arguments.emplace_back("--fresh");
            const RunResult r = folder.run(arguments);
            INFO(name << (fresh ? " --fresh\n" : "\n") << r.err);
            CHECK(r.exit_code == 1);
            CHECK(r.err.find(name) != std::string::npos);
            CHECK(folder.holds(std::string("out/") + name));
        }
    }
    const Folder folder;
    fs::create_directories(folder.file("out/checkpoints"));
    for (const char* name : {"out/checkpoints/notes.txt", "out/notes.txt", "out/methods.json"})
        folder.put(name);
    std::vector<std::string> fresh = trade;
    fresh.emplace_back("--fresh");
    for (const auto& arguments : {trade, fresh}) {
        const RunResult r = folder.run(arguments);
        INFO(r.err);
        CHECK(r.exit_code == 0);
        for (const char* name : {"out/checkpoints/notes.txt", "out/notes.txt", "out/methods.json"})
            CHECK(folder.holds(name));
    }
}

TEST_CASE("Exports and comparisons replace nothing that they did not write", "[command][bystanders]") {
    const Folder folder;
    fs::create_directory(folder.file("out"));
    folder.put("out/scene.xml"), folder.put("a_difference.png");
    CHECK(folder.run({"export", "scene.xml", "--to", "mitsuba3", "-o", "out"}).exit_code == 1);
    CHECK(folder.holds("out/scene.xml"));
    REQUIRE(folder.run(render_a).exit_code == 0);
    CHECK(folder.run({"compare", "a.exr", "a.exr", "--difference", "x4"}).exit_code == 1);
    CHECK(folder.holds("a_difference.png"));
    folder.put("a_denoised.exr");
    CHECK(folder.run({"denoise", "a.exr", "--method", "bmfr"}).exit_code == 1);
    CHECK(folder.holds("a_denoised.exr"));
    for (int i = 0; i < 2; ++i) {  // what they wrote themselves they replace
        CHECK(folder.run({"export", "scene.xml", "--to", "mitsuba3", "-o", "export"}).exit_code == 0);
        CHECK(folder.run({"compare", "a.exr", "a.exr", "--difference", "x4", "-o", "d.png"}).exit_code == 0);
    }
}
