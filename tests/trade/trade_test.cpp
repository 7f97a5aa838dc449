// mote trade as a command: outputs, refusals, interruption, fairness and bias.
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/subcommands.h"
#include "apps/trade_command.h"
#include "core/formats/pictures/image_file.h"
#include "core/render/render_driver.h"
#include "session/reference_metadata.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "trade/methods_file.h"
#include "trade/record.h"
#include "trade/reference.h"

using namespace mote::tests;
using mote::trade::Record;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

// A corner of two diffuse walls, so that bounded VPLs have something to lose.
const char* const corner = R"(<scene version="3.0.0">
    <default name="size" value="16"/>
    <default name="x" value="3"/>
    <integrator type="path"><integer name="max_depth" value="6"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="45"/>
        <transform name="to_world"><lookat origin="$x, 2, 3" target="0, 0.7, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm">
            <integer name="width" value="$size"/>
            <integer name="height" value="$size"/>
            <rfilter type="box"/>
        </film>
    </sensor>
    <bsdf type="twosided" id="white"><bsdf type="diffuse"><rgb name="reflectance" value="0.8"/></bsdf></bsdf>
    <shape type="rectangle">
        <transform name="to_world"><scale value="2"/><rotate x="1" angle="-90"/></transform><ref id="white"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world"><scale value="2"/><translate y="2" z="-2"/></transform><ref id="white"/>
    </shape>
    <emitter type="point"><point name="position" x="0.5" y="1.5" z="0"/><rgb name="intensity" value="4"/></emitter>
</scene>
)";

const char* const methods = R"({
  "passes": 32, "seeds": 2,
  "methods": [
    {"name": "path", "integrator": "path"},
    {"name": "VPL bounded", "integrator": "mote_vpl", "settings": {"paths": 16, "bound": 0.02}},
    {"name": "VPL unbounded", "integrator": "mote_vpl", "settings": {"paths": 16, "bound": -1}}
  ]
})";

struct TradeFolder : TemporaryFolder {
    TradeFolder() {
        write_file(file("corner.xml"), corner);
        write_file(file("methods.json"), methods);
    }
    bool has(const std::string& name) const { return fs::exists(file(name)); }
    /// mote trade corner.xml --methods methods.json with more arguments.
    RunResult trade(std::vector<std::string> more) const {
        std::vector<std::string> arguments = {"trade", "corner.xml", "--methods", "methods.json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_mote(*this, arguments);
    }
    RunResult make_reference(std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments = {"trade",     "corner.xml", "--make-reference", "ref.exr",
                                              "--resolve", "0.05",       "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_mote(*this, arguments);
    }
    std::vector<Record> records(const std::string& folder) const {
        const std::string path = file(folder + "/trade.csv");
        return mote::trade::records_from_csv(read_file(path), path);
    }
    std::unique_ptr<mote::core::Scene> scene(const std::vector<std::string>& defines = {}) const {
        const auto options = mote::session::load_options(mote::apps::scene_changes({"", "", defines}));
        return mote::core::load_scene(file("corner.xml"), registry(), options);
    }
    json summary(const std::string& folder) const {
        return json::parse(read_file(file(folder + "/summary.json")));
    }
};

/// With a reference, made once: its bits are always the same.
struct JudgedFolder : TradeFolder {
    JudgedFolder() {
        static const std::string bytes = [] {
            const TradeFolder folder;
            const RunResult r = folder.make_reference();
            INFO(r.err);
            REQUIRE(r.exit_code == 0);
            return read_file(folder.file("ref.exr"));
        }();
        write_file(file("ref.exr"), bytes);
    }
    /// The reference with every value times `factor`, some metadata taken away.
    void write_changed(const std::string& name, float factor,
                       const std::vector<std::string>& without = {}) const {
        const auto source = mote::core::read_exr(file("ref.exr"));
        mote::core::ImageChannels image;
        image.width = source.width, image.height = source.height;
        auto pixels = source.rgb("");
        for (auto& p : pixels) p *= factor;
        image.add_rgb("", pixels);
        if (std::find(without.begin(), without.end(), "Variance") == without.end())
            image.add_rgb("Variance", source.rgb("Variance"));
        for (const char* key : {"worldToCamera", "sceneContent", "seed", "integrator", "varianceGain"})
            if (std::find(without.begin(), without.end(), key) == without.end())
                image.metadata[key] = source.metadata.at(key);
        mote::core::write_exr(file(name), image);
    }
};

using Key = std::tuple<std::string, std::uint64_t, std::uint32_t>;
std::map<Key, Record> by_key(const std::vector<Record>& records) {
    std::map<Key, Record> map;
    for (const Record& r : records) {
        INFO(r.method << " " << r.seed << " " << r.passes);
        REQUIRE(map.emplace(Key{r.method, r.seed, r.passes}, r).second);
    }
    return map;
}

/// All that does not depend on clocks.
void check_same_errors(const std::vector<Record>& a, const std::vector<Record>& b) {
    const auto first = by_key(a), second = by_key(b);
    REQUIRE(first.size() == second.size());
    for (const auto& [key, r] : first) {
        INFO(r.method << " " << r.seed << " " << r.passes);
        REQUIRE(second.count(key) == 1);
        const Record& s = second.at(key);
        CHECK(r.error == s.error);
        CHECK(r.relmse_trimmed == s.relmse_trimmed);
        CHECK(r.bias == s.bias);
        CHECK((r.bias_se == s.bias_se || (std::isnan(r.bias_se) && std::isnan(s.bias_se))));
        CHECK(r.final == s.final);
    }
}

void check_refused(const RunResult& r, const std::string& part, int exit_code = 1) {
    INFO(r.err);
    CHECK(r.exit_code == exit_code);
    CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 1);
    CHECK(r.err.find(part) != std::string::npos);
    CHECK(r.out.empty());
}

/// Passes and seconds of the earliest state that a checkpoint of a trade can be of.
std::pair<std::uint32_t, double> first_state_of(const std::string& film) {
    std::pair<std::uint32_t, double> first{~0u, 0.0};
    for (const json& state : json::parse(read_file(film.substr(0, film.rfind(".film")) + ".json")))
        if (const auto passes = state.at("passes").get<std::uint32_t>(); passes < first.first)
            first = {passes, state.at("build_wall").get<double>() + state.at("wall").get<double>()};
    return first;
}

const json& method(const json& summary, const std::string& name) {
    for (const json& m : summary.at("methods"))
        if (m.at("name") == name) return m;
    throw std::out_of_range(name);
}

}  // namespace

TEST_CASE("A reference says how exact it is, and is not made twice", "[trade][command]") {
    const TradeFolder folder;
    RunResult r = folder.make_reference({"--passes", "4"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    // Smallest error that the reference can judge, from the variance in the file.
    const auto smallest = [&] {
        const auto image = mote::core::read_exr(folder.file("ref.exr"));
        const auto variance = mote::session::variance_of_beauty(image);
        return mote::trade::smallest_error(
            variance, mote::core::relative_weights(image.rgb(""), variance, image.width, image.height));
    };
    CHECK(smallest() > 0.05);
    CHECK(folder.has("ref.exr.checkpoint"));  // not good enough yet
    REQUIRE(folder.make_reference().exit_code == 0);
    CHECK_FALSE(folder.has("ref.exr.checkpoint"));
    const auto image = mote::core::read_exr(folder.file("ref.exr"));
    CHECK(smallest() <= 0.05);
    CHECK(smallest() > 0.04);
    CHECK(image.metadata.at("integrator") == "path");
    CHECK(std::stod(image.metadata.at("noise")) > 0.05);  // noisier than what it judges

    const auto time = fs::last_write_time(folder.file("ref.exr"));
    CHECK(folder.make_reference().exit_code == 0);
    CHECK(fs::last_write_time(folder.file("ref.exr")) == time);
}

TEST_CASE("A trade writes everything, the pictures with the bits of mote render", "[trade][command]") {
    const JudgedFolder folder;
    const RunResult r = folder.trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05", "--quiet"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    CHECK(r.out == "out/trade.csv\nout/trade.svg\nout/trade.txt\nout/summary.json\nout/trade.html\n");

    const auto records = by_key(folder.records("out"));
    CHECK(records.size() == 3 * 2 * 6);  // 1, 2, 4, 8, 16, 32 passes
    for (const auto& [key, record] : records) {
        CHECK(record.error >= std::abs(record.bias));
        CHECK(record.error_se > 0.0);
        CHECK(record.final == (record.passes == 32));
        CHECK(record.wall >= record.build);
        CHECK(record.cpu > 0.0);
        CHECK(record.non_finite == 0);
    }
    const json summary = folder.summary("out");
    CHECK(summary.at("complete") == true);
    CHECK(summary.at("methods").size() == 3);
    CHECK(json::parse(read_file(folder.file("out/vpl-bounded.json"))) == method(summary, "VPL bounded"));

    const std::string html = read_file(folder.file("out/trade.html"));
    CHECK(html.find("src=\"http") == std::string::npos);
    CHECK(html.find("<svg") != std::string::npos);
    const auto begin = html.find("const book = ") + 13;
    const json book = json::parse(html.substr(begin, html.find(";\n", begin) - begin));
    CHECK(book.at("pictures").size() == 4);  // with the reference
    CHECK(book.at("width") == 16);
    CHECK(html.find("id=\"difference\"") != std::string::npos);
    CHECK(html.find("zoomBy") != std::string::npos);

    REQUIRE(
        run_mote(folder, {"render", "corner.xml", "--integrator", "mote_vpl", "-D", "integrator.bound=0.02",
                          "-D", "integrator.paths=16", "--seed", "1", "--passes", "32", "-o", "v.exr"})
            .exit_code == 0);
    CHECK(mote::core::read_exr(folder.file("v.exr")).channels ==
          mote::core::read_exr(folder.file("out/vpl-bounded.exr")).channels);

    // Again: nothing is left to do. Other inputs: refused, unless --fresh is given.
    const std::string csv = read_file(folder.file("out/trade.csv"));
    CHECK(folder.trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05", "--quiet"}).exit_code ==
          0);
    CHECK(read_file(folder.file("out/trade.csv")) == csv);
    check_refused(folder.trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05", "--passes", "2"}),
                  "passes");
    check_refused(folder.trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05", "--seeds", "1"}),
                  "seeds");
    CHECK(read_file(folder.file("out/trade.csv")) == csv);
    CHECK(folder
              .trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05", "--seeds", "1", "--passes",
                      "2", "--quiet", "--fresh"})
              .exit_code == 0);
    CHECK(folder.records("out").size() == 3 * 2);
}

TEST_CASE("A trade needs no more than a scene", "[trade][command]") {
    const TradeFolder folder;
    const RunResult r =
        run_mote(folder, {"trade", "corner.xml", "--passes", "4", "--seeds", "1", "--resolve", "0.05"});
    INFO(r.err << r.out);
    REQUIRE(r.exit_code == 0);
    const json summary = folder.summary("corner_trade");
    CHECK(summary.at("complete") == true);
    CHECK(summary.at("methods").size() >= 5);
    CHECK(method(summary, "path").at("error").get<double>() > 0.0);
    // Sorted by name, so that the same settings are the same method in whatever order they were written.
    CHECK(method(summary, "VPL, exact compensation").at("settings") == "compensation=exact paths=64");
    // The reference says how noisy it is, and the table on the terminal what came out.
    CHECK(summary.at("facts").at("reference").at("noise").get<double>() > 0.0);
    CHECK(folder.has("corner_trade/automatic_reference.exr"));
    const std::string table = read_file(folder.file("corner_trade/trade.txt"));
    CHECK(r.out.find(table) == 0);
    CHECK(table.find("VPL bounded") != std::string::npos);
    CHECK(table.find("The reference has a noise of") != std::string::npos);
    // Again: the reference is there, and everything measured.
    const std::string csv = read_file(folder.file("corner_trade/trade.csv"));
    CHECK(run_mote(folder,
                   {"trade", "corner.xml", "--passes", "4", "--seeds", "1", "--resolve", "0.05", "--quiet"})
              .exit_code == 0);
    CHECK(read_file(folder.file("corner_trade/trade.csv")) == csv);
}

TEST_CASE("A nested object of a method is an object or dotted names", "[trade]") {
    const JudgedFolder folder;
    const auto scene = folder.scene();
    const auto read = [&](const std::string& settings) {
        std::vector<std::string> warnings;
        const std::string text =
            R"({"passes": 1, "methods": [{"name": "a", "integrator": "mote_vpl", "settings": )" + settings +
            "}]}";
        return mote::trade::read_methods(text, "m.json", registry(), *scene, warnings).methods[0];
    };
    const auto nested = read(R"({"paths": 4, "compensation": {"depth": 1, "type": "approximate"}})");
    const auto dotted = read(R"({"paths": 4, "compensation": "approximate", "compensation.depth": 1})");
    CHECK(nested.settings == dotted.settings);
    CHECK(nested.render_options() == dotted.render_options());
    CHECK_THROWS_WITH(read(R"({"compensation": {"depth": 1}})"),
                      ContainsSubstring("'compensation' needs a 'type'"));
    CHECK_THROWS_WITH(read(R"({"compensation": {"type": "exact"}, "compensation": "exact"})"),
                      ContainsSubstring("given twice"));
    CHECK_THROWS_WITH(read(R"({"compensation": {"type": "approximate", "depht": 1}})"),
                      ContainsSubstring("did you mean 'depth'"));
}

TEST_CASE("Drawing again takes in another renderer's records", "[trade][command]") {
    const JudgedFolder folder;
    REQUIRE(
        folder.trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05", "--passes", "2", "--quiet"})
            .exit_code == 0);
    const std::string head = "method,seed,passes,wall_s,error\n";
    write_file(folder.file("out/other.peer.csv"),
               head + "other renderer,1,1,0.5,0.3\nother renderer,1,2,1,0.2\n");
    fs::copy_file(folder.file("ref.exr"), folder.file("out/other-renderer.exr"));
    const RunResult r = run_mote(folder, {"trade", "--redraw", "-o", "out"});
    INFO(r.err);
    CHECK(r.exit_code == 0);
    const std::string html = read_file(folder.file("out/trade.html"));
    CHECK(html.find("\"other renderer\"") != std::string::npos);  // its picture is in the flip book
    CHECK(html.find(">nan") == std::string::npos);
    CHECK(read_file(folder.file("out/trade.svg")).find("other renderer") != std::string::npos);
    CHECK(method(folder.summary("out"), "other renderer").at("peer") == true);
    write_file(folder.file("out/other.peer.csv"), head + "path,1,1,0.5,0.3\n");
    check_refused(run_mote(folder, {"trade", "--redraw", "-o", "out"}), "'path'");
    check_refused(run_mote(folder, {"trade", "--redraw", "-o", "nowhere"}), "nowhere");
    check_refused(run_mote(folder, {"trade", "--redraw", "-o", "."}), "no trade");
}

TEST_CASE("A methods file that is wrong is refused before anything is rendered", "[trade][command]") {
    const JudgedFolder folder;
    const auto scene = folder.scene();
    const auto refused = [&](const std::string& from, const std::string& to, const std::string& part) {
        std::string text = methods;
        const auto at = text.find(from);
        REQUIRE(at != std::string::npos);
        text.replace(at, from.size(), to);
        write_file(folder.file("methods.json"), text);
        std::vector<std::string> warnings;
        CHECK_THROWS_WITH(
            mote::trade::read_methods_file(folder.file("methods.json"), registry(), *scene, warnings),
            ContainsSubstring(part));
    };
    const auto refused_by_command = [&](const std::string& part) {
        check_refused(folder.trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05"}), part);
        CHECK_FALSE(folder.has("out"));
    };
    refused("\"integrator\": \"path\"", "\"integrator\": \"paht\"",
            "methods.json:4: unknown integrator type 'paht' (did you mean 'path'?)");
    refused_by_command("methods.json:4: unknown integrator");
    refused("\"bound\": -1", "\"bount\": -1", "methods.json:6: integrator 'mote_vpl' has no parameter");
    refused("\"bound\": -1", "\"bount\": -1", "(method 'VPL unbounded')");
    refused_by_command("did you mean 'bound'");
    refused("\"bound\": -1", "\"bound\": true", "'bound'");
    refused("\"bound\": -1", "\"bound\": [1]", "'bound'");
    refused("\"bound\": 0.02", "\"bound\": -2", "bound");
    refused("VPL unbounded", "VPL bounded", "two methods 'VPL bounded'");
    refused("VPL unbounded", "vpl-BOUNDED", "vpl-bounded.exr");
    refused("VPL unbounded", "Reference", "reference.exr");
    refused("\"seeds\"", "\"seed\"", "did you mean 'seeds'");
    refused("\"settings\"", "\"setings\"", "did you mean 'settings'");
    refused("\"seeds\": 2", "\"seeds\": 0", "'seeds'");
    refused("\"passes\": 32", "\"passes\": 0.5", "'passes'");
    refused("\"passes\": 32", "\"time\": \"long\"", "'time'");
    refused("\"name\": \"path\", ", "", "needs 'name'");
    refused("\"passes\": 32, ", "\"passes\": 32, \"passes\": 3, ", "given twice");
    refused("]", "", "not JSON");
    refused(methods, R"({"passes": 1, "methods": []})", "at least one");
    refused(methods, "[]", "expected {");
    write_file(folder.file("methods.json"), R"({"methods": [{"name": "a", "integrator": "path"}]})");
    refused_by_command("neither 'time' nor 'passes'");
    fs::remove(folder.file("methods.json"));
    refused_by_command("methods.json");
}

TEST_CASE("A method keeps what the scene's own integrator sets, unless it says otherwise", "[trade]") {
    const JudgedFolder folder;
    const auto scene = folder.scene();
    write_file(folder.file("methods.json"), R"({"passes": 1, "methods": [
        {"name": "same", "integrator": "path"},
        {"name": "other", "integrator": "volpath", "settings": {"max_depth": 1}}]})");
    std::vector<std::string> warnings;
    const auto file =
        mote::trade::read_methods_file(folder.file("methods.json"), registry(), *scene, warnings);
    const auto brightness = [&](const mote::core::Integrator& integrator) {
        mote::core::RenderRequest request;
        request.stop.passes = 4;
        double sum = 0.0;
        for (const auto& p : mote::core::render(*scene, integrator, request).film.beauty()) sum += p.x;
        return sum;
    };
    CHECK(brightness(*file.methods[0].integrator) == brightness(*scene->integrator()));
    CHECK(brightness(*file.methods[1].integrator) < brightness(*scene->integrator()));
    CHECK(warnings.empty());
}

TEST_CASE("A reference that cannot judge is refused with the reason", "[trade][command]") {
    using mote::trade::load_reference;
    const JudgedFolder folder;
    const auto load = [&](const std::string& file, double resolve,
                          const std::vector<std::string>& defines = {}, bool trust = false,
                          bool force = false) {
        const auto scene = folder.scene(defines);
        return load_reference(folder.file(file), *scene, mote::session::scene_content(*scene, defines),
                              {resolve, trust, force});
    };
    const auto refuses = [](const std::string& part) { return ContainsSubstring(part); };
    CHECK(load("ref.exr", 0.05).floor() == Approx(0.05).epsilon(0.1));
    CHECK_THROWS_WITH(load("ref.exr", 0.01), refuses("too noisy") && refuses("--make-reference"));
    CHECK_THROWS_WITH(load("missing.exr", 0.05), refuses("missing.exr"));
    CHECK_THROWS_WITH(load("ref.exr", 0.05, {"size=8"}), refuses("16 x 16 pixels, the scene's film 8 x 8"));
    CHECK_THROWS_WITH(load("ref.exr", 0.05, {"x=3.01"}), refuses("another camera"));
    CHECK_THROWS_WITH(load("ref.exr", 0.05, {"x=3.01"}, true, true), refuses("another camera"));
    CHECK_THROWS_WITH(load("ref.exr", 0.05, {"integrator.max_depth=2"}), refuses("another version"));
    CHECK_NOTHROW(load("ref.exr", 0.05, {"integrator.max_depth=2"}, false, true));

    folder.write_changed("nan.exr", std::nanf(""));
    CHECK_THROWS_WITH(load("nan.exr", 0.05), refuses("256 of its 256 pixels are NaN"));
    folder.write_changed("black.exr", 0.0f);
    CHECK_THROWS_WITH(load("black.exr", 0.05), refuses("black"));
    for (const char* key : {"Variance", "worldToCamera", "sceneContent"}) {
        folder.write_changed("unknown.exr", 1.0f, {key});
        CHECK_THROWS_WITH(load("unknown.exr", 0.05), refuses(key) && refuses("--trust-reference"));
        CHECK_NOTHROW(load("unknown.exr", 0.05, {}, true));
    }
    // By the command: refused before it makes the folder.
    check_refused(folder.trade({"--reference", "ref.exr", "-o", "out"}), "too noisy");
    REQUIRE(run_mote(folder, {"render", "corner.xml", "--integrator", "mote_vpl", "--passes", "2", "-o",
                              "v.exr", "--quiet"})
                .exit_code == 0);
    check_refused(folder.trade({"--reference", "v.exr", "--resolve", "9", "-o", "out"}),
                  "mote_vpl, which leaves out: short distances");
    CHECK_FALSE(folder.has("out"));
}

TEST_CASE("Wrong usage of trade ends with 2", "[trade][command]") {
    const TradeFolder folder;
    const auto refused = [](const mote::apps::TradeArguments& a, const std::string& part) {
        CHECK_THROWS_AS(mote::apps::trade_command(a), mote::apps::UsageError);
        CHECK_THROWS_WITH(mote::apps::trade_command(a), ContainsSubstring(part));
    };
    check_refused(run_mote(folder, {"trade"}), "SCENE", 2);
    mote::apps::TradeArguments a;
    a.settings.scene = "corner.xml";
    a.settings.output = "out", a.make_reference.integrator = "path";
    refused(a, "--integrator");
    a.make_reference.path = "a.png";
    refused(a, ".exr");
    check_refused(folder.make_reference({"--integrator", "pth"}), "path");
}

TEST_CASE("An interrupted trade continues to the errors of one that was not", "[trade][command]") {
    const JudgedFolder folder;
    write_file(folder.file("methods.json"), R"({"passes": 3000, "seeds": 2, "methods": [
        {"name": "path", "integrator": "path"},
        {"name": "VPL", "integrator": "mote_vpl", "settings": {"paths": 32}}]})");
    const auto arguments = [](const std::string& out) {
        return std::vector<std::string>{
            "trade", "corner.xml",         "--methods", "methods.json", "--resolve",
            "0.05",  "--reference",        "ref.exr",   "--quiet",      "-t",
            "1",     "--checkpoint-every", "0.05",      "-o",           out};
    };
    REQUIRE(run_mote(folder, arguments("whole")).exit_code == 0);
    const auto whole = folder.records("whole");

    for (const auto& [name, signal_number] : {std::pair("stopped", SIGINT), std::pair("killed", SIGKILL)}) {
        INFO(name);
        const std::string film = folder.file(std::string(name) + "/checkpoints/vpl.seed1.film");
        // On a busy machine the signal may come when the seed is done, and its checkpoint gone or of no more
        // use: then once more.
        const auto cut_in_time = [&, out = std::string(name)] {
            if (!fs::exists(film)) return false;
            const auto records = folder.records(out);
            return std::none_of(records.begin(), records.end(), [](const Record& record) {
                return record.method == "VPL" && record.seed == 1 && record.final;
            });
        };
        RunResult r;
        for (int attempt = 0; attempt < 20 && !cut_in_time(); ++attempt) {
            fs::remove_all(folder.file(name));
            MoteProcess process(folder, arguments(name));
            if (wait_for_file(process, film)) process.send(signal_number);
            r = process.wait();
        }
        INFO(r.err);
        REQUIRE(cut_in_time());
        CHECK(r.exit_code == (signal_number == SIGINT ? 130 : -1));
        CHECK(folder.records(name).size() < whole.size());
        const auto [passes, seconds] = first_state_of(film);

        const std::string bytes = read_file(film);  // a damaged checkpoint is an error, not another picture
        write_file(film, bytes.substr(0, 500));
        check_refused(run_mote(folder, arguments(name)), "vpl.seed1.film");
        write_file(film, bytes);

        REQUIRE(run_mote(folder, arguments(name)).exit_code == 0);
        check_same_errors(folder.records(name), whole);
        CHECK_FALSE(folder.has(std::string(name) + "/checkpoints"));
        CHECK(mote::core::read_exr(folder.file(std::string(name) + "/vpl.exr")).channels ==
              mote::core::read_exr(folder.file("whole/vpl.exr")).channels);
        int continued = 0;
        for (const Record& record : folder.records(name)) {
            if (record.method != "VPL" || record.seed != 1 || record.passes <= passes) continue;
            CHECK(record.wall > seconds);  // those of the first run are kept
            ++continued;
        }
        CHECK(continued > 0);
    }
}

TEST_CASE("Within a time limit every method gets its time", "[trade][command]") {
    const JudgedFolder folder;
    const RunResult r = folder.trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05", "--quiet",
                                      "--time", "0.3", "--seeds", "1"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    int methods_done = 0;
    for (const Record& record : folder.records("out")) {
        if (!record.final) continue;
        ++methods_done;
        INFO(record.method << " " << record.passes);
        const double pass = (record.wall - record.build) / record.passes;
        CHECK(record.wall + 0.5 * pass >= 0.299);
        CHECK(record.wall < 30.0);  // far less, but the system may hold a pass up
    }
    CHECK(methods_done == 3);
}

TEST_CASE("A bias is found where there is one, and only there", "[trade][command]") {
    const JudgedFolder folder;
    write_file(folder.file("methods.json"), R"({"passes": 256, "seeds": 2, "methods": [
        {"name": "volpath", "integrator": "volpath"},
        {"name": "bounded", "integrator": "mote_vpl", "settings": {"paths": 64, "bound": 0.02}}]})");
    REQUIRE(folder.trade({"--reference", "ref.exr", "-o", "out", "--resolve", "0.05", "--quiet"}).exit_code ==
            0);
    const json honest = folder.summary("out");
    INFO(honest.dump(1));
    CHECK(method(honest, "volpath").at("bias_significant") == false);
    CHECK(method(honest, "bounded").at("bias_significant") == true);
    CHECK(method(honest, "bounded").at("bias").get<double>() < -0.01);
    CHECK(method(honest, "bounded").at("time_to_reach").back().at("kind") != "extrapolated");

    folder.write_changed("planted.exr", 1.03f);
    REQUIRE(folder.trade({"--reference", "planted.exr", "-o", "planted", "--resolve", "0.05", "--quiet"})
                .exit_code == 0);
    const json planted = method(folder.summary("planted"), "volpath");
    INFO(planted.dump(1));
    CHECK(planted.at("bias_significant") == true);
    CHECK(planted.at("bias").get<double>() == Approx(1.0 / 1.03 - 1.0).margin(0.01));
}
