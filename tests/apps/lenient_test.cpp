// Errors, --lenient, aov and what is reported about media, as the command shows them.
#include <nlohmann/json.hpp>

#include "media/vol_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

const std::string head = R"(<scene version="3.0.0"><integrator type="path"/>
<sensor type="perspective"><transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
<emitter type="constant"/>
)";

}  // namespace

TEST_CASE("every error is a line, in the file's order, and the exit code is 1", "[lenient]") {
    const TemporaryFolder folder;
    write_file(folder.file("s.xml"),
               head + "<shape type='spere'/>\n<bsdf type='difuse'/>\n<shape type='obj'/>\n</scene>");
    const RunResult plan = run_mote(folder, {"plan", "s.xml"});
    CHECK(plan.exit_code == 1);
    const auto lines = lines_of(plan.err);
    REQUIRE(lines.size() == 3);
    CHECK(lines[0] == "mote: s.xml:5: unknown shape type 'spere' (did you mean 'sphere'?)");
    CHECK(lines[1] == "mote: s.xml:6: unknown bsdf type 'difuse' (did you mean 'diffuse'?)");
    CHECK(lines[2].starts_with("mote: s.xml:7: shape 'obj' needs"));
    std::string many = head;
    for (int i = 0; i < 50; ++i) many += "<bsdf type='difuse'/>\n";
    write_file(folder.file("many.xml"), many + "</scene>");
    const auto limited = lines_of(run_mote(folder, {"plan", "many.xml"}).err);
    REQUIRE(limited.size() == 21);
    CHECK(limited.back() == "mote: ... and 30 more errors");
}

TEST_CASE("--lenient renders the rest, and says what it did in log, statistics and picture", "[lenient]") {
    const TemporaryFolder folder;
    write_file(folder.file("s.xml"),
               head + "<shape type='sphere'><bsdf type='velvet'/></shape>\n<shape type='torus'/>\n</scene>");
    CHECK(run_mote(folder, {"render", "s.xml", "--passes", "1"}).exit_code == 1);
    const RunResult r = run_mote(
        folder, {"render", "s.xml", "--lenient", "--passes", "1", "-o", "o.exr", "--stats", "o.json"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    CHECK(r.err.find("--lenient: s.xml:5: unknown bsdf type 'velvet'") != std::string::npos);
    const auto json = nlohmann::json::parse(read_file(folder.file("o.json")));
    REQUIRE(json["approximations"].size() == 2);
    CHECK(std::string(json["approximations"][1]).starts_with("s.xml:6: unknown shape type 'torus'"));
    CHECK(run_mote(folder, {"info", "o.exr"}).out.find("approximations = s.xml:5:") != std::string::npos);
    CHECK(run_mote(folder, {"info", "s.xml", "--lenient"}).out.find("velvet") != std::string::npos);
    CHECK(run_mote(folder, {"plan", "s.xml", "--lenient"}).err.find("torus") != std::string::npos);
    CHECK(run_mote(folder, {"export", "s.xml", "--lenient", "--to", "mitsuba3", "-o", "there"}).exit_code ==
          0);
}

TEST_CASE("the features of aov are layers of the picture", "[lenient]") {
    const TemporaryFolder folder;
    std::string text = head + "<shape type='sphere'/></scene>";
    const std::string plain = "<integrator type=\"path\"/>";
    text.replace(
        text.find(plain), plain.size(),
        "<integrator type='aov'><string name='aovs' value='d:depth,n:sh_normal'/>" + plain + "</integrator>");
    write_file(folder.file("s.xml"), text);
    const RunResult r = run_mote(folder, {"render", "s.xml", "--passes", "1", "-o", "o.exr"});
    INFO(r.err);
    REQUIRE(r.exit_code == 0);
    const std::string info = run_mote(folder, {"info", "o.exr"}).out;
    CHECK(info.find("Depth") != std::string::npos);
    CHECK(info.find("Ns.") != std::string::npos);
    CHECK(info.find("Albedo") == std::string::npos);
}

TEST_CASE("a grid beside its shape and a camera that does not name its fog are reported", "[lenient]") {
    const TemporaryFolder folder;
    mote::media::VolFile file;
    file.resolution = {1, 1, 1}, file.values = {1.0f};
    file.bounds = {mote::core::Vec3(0.0f), mote::core::Vec3(1.0f)};
    mote::media::write_vol_file(folder.file("g.vol"), file);
    const auto scene = [&](const std::string& placed) {
        return head +
               "<shape type='cube'><bsdf type='null'/><medium type='heterogeneous' name='interior' id='g'>"
               "<volume type='gridvolume' name='sigma_t'><string name='filename' value='g.vol'/>"
               "<transform name='to_world'>" +
               placed + "</transform></volume></medium></shape></scene>";
    };
    // The cube is [-1, 1]^3: half of one placement lies in it, a tenth of the other.
    write_file(folder.file("good.xml"), scene("<translate x='0.4'/>"));
    write_file(folder.file("bad.xml"), scene("<translate x='0.9'/>"));
    CHECK(run_mote(folder, {"plan", "good.xml"}).err.find("overlap little") == std::string::npos);
    const std::string bad = run_mote(folder, {"plan", "bad.xml"}).err;
    INFO(bad);
    CHECK(bad.find("medium 'g'") != std::string::npos);
    CHECK(bad.find("overlap little: 10 % of the grid's box is in the shapes' box") != std::string::npos);
    write_file(folder.file("fog.xml"),
               head +
                   "<shape type='sphere'><float name='radius' value='9'/><bsdf type='null'/>"
                   "<medium type='homogeneous' name='interior' id='fog'/></shape></scene>");
    CHECK(run_mote(folder, {"plan", "fog.xml"})
              .err.find("the camera stands in medium 'fog', which its sensor does "
                        "not name") != std::string::npos);
}
