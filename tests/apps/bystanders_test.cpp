// Files that the user did not name as outputs are neither written nor removed, whatever they are called.
#include <filesystem>
#include <set>

#include "tests/apps/ball_under_sky.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
namespace fs = std::filesystem;

namespace {

/// A scene, and bystanders that say what they are.
struct Folder : TemporaryFolder {
    Folder() {
        write_file(file("scene.xml"), ball_under_sky(8, 8));
        write_file(file("methods.json"),
                   R"({"passes": 2, "methods": [{"name": "one", "integrator": "path"}]})");
    }
    RunResult run(const std::vector<std::string>& arguments) const { return run_mote(*this, arguments); }
    void put(const std::string& name) const { write_file(file(name), "this is " + name); }
    bool holds(const std::string& name) const { return read_file(file(name)) == "this is " + name; }
};

const std::vector<std::string> render_a = {"render", "scene.xml", "-o", "a.exr", "--passes", "1", "-t", "1"};

}  // namespace

TEST_CASE("A render refuses to replace what it was not given to write", "[command][bystanders]") {
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

namespace {

/// Every name that some command writes or removes, for outputs that are called `base`.
std::vector<std::string> names_we_use(const std::string& base) {
    std::vector<std::string> names;
    for (const char* ending : {".exr",
                               ".png",
                               ".film",
                               ".json",
                               ".html",
                               ".csv",
                               ".xml",
                               ".txt",
                               ".exr.checkpoint",
                               ".film.checkpoint",
                               ".exr.film",
                               ".exr.checkpoint.json",
                               ".part",
                               ".exr.part",
                               ".exr.1-0.part",
                               ".png.part",
                               "_denoised.exr",
                               "_denoised.png",
                               "_difference.png",
                               "_files",
                               "_trade",
                               ".0001.exr",
                               ".0002.exr",
                               ".0001.png",
                               ".0-1.film"})
        names.push_back(base + ending);
    return names;
}

struct Command {
    std::vector<std::string> arguments;
    std::set<std::string> named;  ///< outputs, with the previews and checkpoints that belong to them
};

std::set<std::string> entries(const Folder& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
        if (entry.is_regular_file()) names.insert(fs::relative(entry.path(), folder.path()).string());
    return names;
}

}  // namespace

TEST_CASE("No command writes or removes a path that is no output of its own", "[command][bystanders]") {
    const Command commands[] = {
        {{"render", "scene.xml", "-o", "a.exr", "--passes", "2", "--stats", "s.json", "--checkpoint-every",
          "0"},
         {"a.exr", "a.png", "a.exr.checkpoint", "s.json"}},
        {{"render", "scene.xml", "--pass-range", "1:2", "-o", "p.film"}, {"p.film", "p.film.checkpoint"}},
        {{"merge", "in/0.film", "in/1.film", "-o", "m.exr", "--stats", "s.json"},
         {"m.exr", "m.png", "m.exr.checkpoint", "s.json"}},
        {{"merge", "in/0.film", "in/1.film", "-o", "m.film"}, {"m.film"}},
        {{"render", "scene.xml", "-o", "f.####.exr", "-D", "film.width=8:9", "--passes", "1"},
         {"f.0008.exr", "f.0008.png", "f.0009.exr", "f.0009.png"}},
        {{"convert", "in/a.exr", "c.png"}, {"c.png"}},
        {{"compare", "in/a.exr", "in/a.exr", "--map", "c.png", "--difference", "x4", "-o", "d.png"},
         {"c.png", "d.png"}},
        {{"denoise", "in/a.exr", "-o", "a.exr", "--method", "bmfr"}, {"a.exr", "a.png"}},
        {{"denoise", "in/f.####.exr", "-o", "d.####.exr", "--method", "bmfr"},
         {"d.0001.exr", "d.0001.png", "d.0002.exr", "d.0002.png"}},
        {{"ssbc", "in/v.exr", "-o", "w.exr"}, {"w.exr"}},
        {{"export", "scene.xml", "--to", "mitsuba3", "-o", "e"}, {"e/scene.xml", "e/dropped.txt"}},
        {{"formats"}, {}},
        {{"trade", "scene.xml", "--make-reference", "r.exr", "--resolve", "0.9", "--passes", "8"},
         {"r.exr", "r.png", "r.exr.checkpoint"}},
        {{"plan", "scene.xml"}, {}},
        {{"info", "in/a.exr"}, {}}};
    const Folder inputs;
    REQUIRE(inputs.run({"render", "scene.xml", "-o", "a.exr", "--passes", "2", "--auxiliary"}).exit_code ==
            0);
    REQUIRE(inputs
                .run({"render", "scene.xml", "--integrator", "mote_vpl", "-D", "integrator.bound=5", "-o",
                      "v.exr", "--passes", "1", "--auxiliary"})
                .exit_code == 0);
    for (const char* copy : {"f.0001.exr", "f.0002.exr"})
        fs::copy_file(inputs.file("a.exr"), inputs.file(copy));
    for (const char* range : {"0:1", "1:2"})
        REQUIRE(
            inputs
                .run({"render", "scene.xml", "--pass-range", range, "-o", std::string(1, range[0]) + ".film"})
                .exit_code == 0);
    for (const Command& command : commands) {
        const Folder folder;
        fs::create_directory(folder.file("in"));
        for (const char* name : {"a.exr", "v.exr", "f.0001.exr", "f.0002.exr", "0.film", "1.film"})
            fs::copy_file(inputs.file(name), folder.file(std::string("in/") + name));
        std::vector<std::string> bystanders;
        for (const char* base :
             {"a", "b", "c", "d", "e", "f", "m", "p", "r", "s", "w", "scene", "in/a", "in/0"})
            for (const std::string& name : names_we_use(base))
                if (!command.named.contains(name) && !fs::exists(folder.file(name)))
                    bystanders.push_back(name);
        for (const std::string& name : bystanders) folder.put(name);
        std::set<std::string> before = entries(folder);
        const RunResult r = folder.run(command.arguments);
        INFO(command.arguments[0] << "\n" << r.err);
        CHECK(r.exit_code == 0);
        for (const std::string& name : bystanders) {
            INFO(name);
            CHECK(folder.holds(name));
        }
        before.insert({"stdout.txt", "stderr.txt"});
        before.insert(command.named.begin(), command.named.end());
        for (const std::string& name : entries(folder)) {
            INFO(name);
            CHECK(before.contains(name));
        }
    }
}
