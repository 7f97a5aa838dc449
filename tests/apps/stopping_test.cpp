// How the command ends before its time: signals, --time within a pass, and limits of the system.
//
// What is timed are minutes of work that have to stop; the bounds are generous, for machines are busy.
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
namespace fs = std::filesystem;

namespace {

constexpr double generous_seconds = 20.0;  // two are requested, on a machine that does nothing else

struct Folder : TemporaryFolder {
    Folder() {
        write_file(file("scene.xml"), R"(<scene version="3.0.0"><default name="size" value="64"/>
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="$size"/>
            <integer name="height" value="$size"/></film><transform name="to_world">
            <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
            <shape type="sphere"><bsdf type="diffuse"/></shape>
            <emitter type="constant"/></scene>)");
    }
    std::vector<std::string> render(std::vector<std::string> more) const {
        std::vector<std::string> all = {"render", "scene.xml", "-o", "a.exr", "-t", "1"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    bool has(const std::string& name) const { return fs::exists(file(name)); }
};

/// A pass of an hour, whose pixels are finished one after the other.
const std::vector<std::string> long_pass = {"--integrator", "mote_vpl", "-D", "integrator.paths=100000",
                                            "-D",           "size=1000"};
std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A limit of the child's.
std::function<void()> limited(int what, rlim_t limit) {
    return [=] {
        const rlimit both{limit, limit};
        ::setrlimit(__rlimit_resource_t(what), &both);
    };
}

/// crowd.xml: a million spheres take several seconds to load, and no pixel.
void write_crowd(const Folder& folder) {
    std::string many = "<scene version=\"3.0.0\">", includes;
    for (int i = 0; i < 1000; ++i)
        many += "<shape type=\"sphere\"/>", includes += "<include filename=\"many.xml\"/>";
    write_file(folder.file("many.xml"), many + "</scene>");
    write_file(folder.file("crowd.xml"), R"(<scene version="3.0.0"><sensor type="perspective"/>
        <emitter type="constant"/>)" + includes +
                                             "</scene>");
}

/// True before a run, and after one whose signal came while the program still started.
bool too_early(const RunResult& r) { return r.exit_code == -1 || r.err == "mote: interrupted\n"; }

}  // namespace

TEST_CASE("--time ends within a pass, and says what it has of it", "[command][stopping]") {
    const Folder folder;
    RunResult r;
    CHECK(seconds_of([&] {
              r = run_mote(folder, folder.render(long_pass + std::vector<std::string>{"--time", "2"}));
          }) < generous_seconds);
    INFO(r.err);
    if (r.exit_code == 1) {  // a machine so busy that no pixel came out: then it says so
        CHECK(r.err.find("is over") != std::string::npos);
        return;
    }
    REQUIRE(r.exit_code == 0);
    CHECK(r.err.find("first pass") != std::string::npos);
    CHECK_FALSE(folder.has("a.exr.checkpoint"));
    const auto image = mote::core::read_exr(folder.file("a.exr"));
    CHECK(image.metadata.at("passes") == "0");
    CHECK(image.metadata.count("partOfFirstPass") == 1);
    const auto alpha = std::find(image.names.begin(), image.names.end(), "A");
    REQUIRE(alpha != image.names.end());
    const auto& finished = image.channels[std::size_t(alpha - image.names.begin())];
    const auto pixels = image.rgb("");
    std::size_t missing = 0;
    for (std::size_t i = 0; i < finished.size(); ++i) {
        missing += finished[i] == 0.0f;
        // Every eye ray meets the sphere or the sky.
        CHECK((pixels[i].x > 0.0f) == (finished[i] == 1.0f));
    }
    CHECK(missing > 0);
    CHECK(missing < finished.size());
}

TEST_CASE("Signals stop a pass that would take an hour", "[command][stopping]") {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        const Folder folder;
        RunResult r;
        // A busy machine may take longer to start the program, which has no handler yet then: once more,
        // later.
        for (int wait = 500; too_early(r) && wait < 20000; wait *= 2) {
            MoteProcess process(folder, folder.render(long_pass));
            std::this_thread::sleep_for(std::chrono::milliseconds(wait));
            process.send(number);
            CHECK(seconds_of([&] { r = process.wait(); }) < generous_seconds);
        }
        INFO(r.err);
        // The wait may or may not have been long enough to load the scene, or to finish a pixel.
        CHECK(r.exit_code == 128 + number);
        CHECK(r.err.find("interrupted") != std::string::npos);
        CHECK_FALSE(folder.has("a.exr.checkpoint"));
    }
}

TEST_CASE("A terminal that hangs up saves the picture and the checkpoint", "[command][stopping]") {
    const Folder folder;
    MoteProcess process(
        folder, folder.render({"--integrator", "path", "--passes", "1000000", "--checkpoint-every", "0"}));
    REQUIRE(wait_for_file(process, folder.file("a.exr.checkpoint")));
    process.send(SIGHUP);
    const RunResult r = process.wait();
    INFO(r.err);
    CHECK(r.exit_code == 128 + SIGHUP);
    CHECK(folder.has("a.exr"));
    CHECK(folder.has("a.png"));
    CHECK(folder.has("a.exr.checkpoint"));
}

TEST_CASE("A pipe that is not read can be interrupted", "[command][stopping]") {
    for (const char* passes : {"1", "1000000"}) {  // while it is opened, and while passes are rendered
        RunResult r;
        for (int wait = 500; too_early(r) && wait < 20000; wait *= 2) {  // as above
            const Folder folder;
            REQUIRE(::mkfifo(folder.file("a.exr").c_str(), 0600) == 0);
            MoteProcess process(folder, folder.render({"--integrator", "path", "--passes", passes}));
            std::this_thread::sleep_for(std::chrono::milliseconds(wait));
            process.send(SIGINT);
            CHECK(seconds_of([&] { r = process.wait(); }) < generous_seconds);
        }
        CHECK(r.exit_code == 128 + SIGINT);
        CHECK(r.err.find("interrupted") != std::string::npos);
    }
}

TEST_CASE("A write that hangs says so at the first signal and ends at the second", "[command][stopping]") {
    const Folder folder;  // statistics come last: a pipe without a reader represents a folder that hangs
    REQUIRE(::mkfifo(folder.file("s.json").c_str(), 0600) == 0);
    MoteProcess process(folder,
                        folder.render({"--integrator", "path", "--passes", "1", "--stats", "s.json"}));
    REQUIRE(wait_for_file(process, folder.file("a.png")));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    process.send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    CHECK(process.running());
    process.send(SIGINT);
    const RunResult r = process.wait();
    INFO(r.err);
    CHECK(r.exit_code == 128 + SIGINT);
    CHECK(r.err.find("another signal ends mote at once") != std::string::npos);
    CHECK(folder.has("a.exr"));
}

TEST_CASE("A signal ends a command that has nothing to lose with a line", "[command][stopping]") {
    RunResult r;
    for (int wait = 250; r.exit_code == -1 && wait < 20000; wait *= 2) {  // as above
        const Folder folder;
        write_crowd(folder);
        MoteProcess process(folder, {"plan", "crowd.xml"});
        std::this_thread::sleep_for(std::chrono::milliseconds(wait));
        process.send(SIGTERM);
        r = process.wait();
    }
    CHECK(r.exit_code == 128 + SIGTERM);
    CHECK(r.err == "mote: interrupted\n");
}

TEST_CASE("A limit on the size of files is an error, and leaves none", "[command][stopping]") {
    const Folder folder;
    const RunResult r = run_mote(folder, folder.render({"--integrator", "path", "--passes", "1", "--quiet"}),
                                 limited(RLIMIT_FSIZE, 1000));
    INFO(r.err);
    CHECK(r.exit_code == 1);
    CHECK(r.err.find("a.exr: cannot be written") != std::string::npos);
    for (const auto& entry : fs::directory_iterator(folder.path()))
        CHECK(entry.path().string().find(".part") == std::string::npos);
    CHECK_FALSE(folder.has("a.exr"));
}

TEST_CASE("Where the system grants few threads, those do the work", "[command][stopping]") {
    const Folder folder;
    fs::permissions(folder.path(), fs::perms::all);
    std::vector<std::string> arguments = folder.render({"--integrator", "path", "--passes", "1"});
    arguments[5] = "4";
    // Libraries start threads of their own before main(), and how many is up to them: more and more until
    // the program says that it has two. The limit does not hold for root, which becomes an unprivileged user.
    for (rlim_t limit = 1; limit < 64; ++limit) {
        const RunResult r = run_mote(folder, arguments, [limit] {
            limited(RLIMIT_NPROC, limit)();
            if (::getuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(126);
        });
        if (r.exit_code == 126 || r.exit_code == 127) break;
        if (r.err.find("grants 2 threads instead of 4") == std::string::npos) continue;
        INFO(r.err);
        CHECK(r.exit_code == 0);
        CHECK(folder.has("a.exr"));
        return;
    }
    WARN("no limit leaves two threads here, or an unprivileged user may not run the program: not tested");
}

TEST_CASE("Where the system grants no threads, one line says so", "[command][stopping]") {
    const Folder folder;
    fs::permissions(folder.path(), fs::perms::all);
    const RunResult r = run_mote(folder, {"formats"}, [] {
        limited(RLIMIT_NPROC, 1)();
        if (::getuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(126);
    });
    if (r.exit_code == 126 || r.exit_code == 127 || r.exit_code == 0) {
        WARN("an unprivileged user may not run the program, or limits do not hold here: not tested");
        return;
    }
    CHECK(r.exit_code == 3);
    CHECK(r.err.find("mote: the system grants too few threads") == 0);
}

TEST_CASE("Too little memory names what it was for", "[command][stopping]") {
    const Folder folder;
    const RunResult r =
        run_mote(folder, folder.render({"--integrator", "path", "-D", "size=16000", "--quiet"}),
                 limited(RLIMIT_AS, rlim_t(4) << 30));
    INFO(r.err);
    CHECK(r.exit_code == 3);
    CHECK(r.err.find("not enough memory for a film of 16000 x 16000 pixels") != std::string::npos);
    CHECK(r.err.find(" GB are available; at most ") != std::string::npos);
    // Before anything is built, with a sentence instead of the kernel's end.
    RunResult whole;
    CHECK(seconds_of([&] {
              whole =
                  run_mote(folder, folder.render({"--integrator", "path", "-D", "size=16384", "--auxiliary"}),
                           limited(RLIMIT_AS, rlim_t(8) << 30));
          }) < generous_seconds);
    CHECK(whole.exit_code == 3);
    CHECK(whole.err.find("mote: there is not enough memory for a film of 16384 x 16384 pixels") !=
          std::string::npos);
    for (const char* name : {"a.exr", "a.png", "a.exr.checkpoint"}) CHECK_FALSE(folder.has(name));
}

TEST_CASE("A trade and its reference end at once while the scene is loaded", "[command][stopping][trade]") {
    const Folder folder;
    write_crowd(folder);
    for (const auto& arguments : {std::vector<std::string>{"trade", "crowd.xml", "--make-reference", "r.exr"},
                                  std::vector<std::string>{"trade", "crowd.xml"}}) {
        RunResult r;
        for (int wait = 250; too_early(r) && wait < 20000; wait *= 2) {  // as above
            MoteProcess process(folder, arguments);
            std::this_thread::sleep_for(std::chrono::milliseconds(wait));
            process.send(SIGINT);
            CHECK(seconds_of([&] { r = process.wait(); }) < generous_seconds);
        }
        INFO(r.err);
        CHECK(r.exit_code == 128 + SIGINT);
        CHECK(r.err.find("interrupted while loading the scene: no pixel was rendered yet") !=
              std::string::npos);
    }
}

TEST_CASE("without progress nothing is spent on previews of a short render, unless its time is limited",
          "[stopping]") {
    const Folder folder;
    const auto makes_previews = [&](const std::vector<std::string>& more) {
        REQUIRE(run_mote(folder, folder.render(more) +
                                     std::vector<std::string>{"--integrator", "path", "--stats", "a.json"})
                    .exit_code == 0);
        return nlohmann::json::parse(read_file(folder.file("a.json")))["seconds"].contains("previews");
    };
    CHECK(makes_previews({"--passes", "3"}));
    CHECK_FALSE(makes_previews({"--passes", "3", "--quiet"}));
    CHECK(makes_previews({"--passes", "3", "--time", "60", "--quiet"}));
}
