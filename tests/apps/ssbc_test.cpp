// mote ssbc: adds the layer, says what is missing, refuses what cannot be done.
#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/screenspace/ssbc_exr.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using namespace mote::core;

namespace {

const Pinhole camera{{0.2, 0.3, 3.6}, {0.1, 0, 0}, {0.1, 1, 0}, std::tan(0.35), 48, 36};

struct Picture : TemporaryFolder {
    ImageChannels image = exr_of(picture_of(room_walls(), camera), camera);
    void write() const { write_exr(file("in.exr"), image); }
    RunResult ssbc(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"ssbc", "in.exr", "-o", "out.exr"});
        return run_mote(*this, more);
    }
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

double total(const std::vector<Rgb>& pixels) {
    double sum = 0.0;
    for (const Rgb& p : pixels) sum += double(average(p));
    return sum;
}

}  // namespace

TEST_CASE("ssbc adds a layer and adds it to the beauty", "[command][ssbc]") {
    const Picture folder;
    folder.write();
    const RunResult run = folder.ssbc({"--bound", "10", "--steps", "3"});
    INFO(run.out << run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(run.err.empty());
    CHECK(contains(run.out, "direct + indirect_bounded"));
    const ImageChannels out = read_exr(folder.file("out.exr"));
    const std::vector<Rgb> added = out.rgb("compensation_surface"), before = folder.image.rgb("");
    REQUIRE(added.size() == before.size());
    CHECK(total(added) > 0.001 * total(before));
    const std::vector<Rgb> after = out.rgb("");
    for (std::size_t i = 0; i < after.size(); ++i) CHECK(after[i].x == Approx(before[i].x + added[i].x));
    CHECK(out.metadata.at("ssbc") == "bound 10, steps 3");
    CHECK(out.metadata.contains("worldToCamera"));

    const RunResult flat = folder.ssbc({"--bound", "10", "--steps", "3", "--flat"});
    REQUIRE(flat.exit_code == 0);
    CHECK(total(read_exr(folder.file("out.exr")).rgb("compensation_surface")) ==
          Approx(total(added)).epsilon(0.01));
}

TEST_CASE("ssbc says what a picture lacks", "[command][ssbc]") {
    Picture folder;
    folder.write();
    const RunResult no_bound = folder.ssbc();
    CHECK(no_bound.exit_code == 1);
    CHECK(contains(no_bound.err, "in.exr: the picture does not say with which bound it was rendered"));
    folder.image.metadata["bound"] = "10";
    for (std::string& name : folder.image.names)
        if (name.starts_with("Albedo")) name[0] = 'X';
    folder.write();
    const RunResult no_albedo = folder.ssbc();
    CHECK(no_albedo.exit_code == 1);
    CHECK(contains(no_albedo.err, "in.exr: the picture lacks 'Albedo' (diffuse reflectance)"));
    CHECK(folder.ssbc({"--albedo", "Xlbedo"}).exit_code == 0);
    CHECK(run_mote(folder, {"ssbc", "out.exr", "-o", "again.exr", "--albedo", "Xlbedo"}).exit_code == 1);
    CHECK(folder.ssbc({"--bound", "-1"}).exit_code == 2);
    CHECK(folder.ssbc({"--steps", "0"}).exit_code == 2);
}

TEST_CASE("ssbc takes surfaces from the scene that a picture shows", "[command][ssbc]") {
    const TemporaryFolder folder;
    write_file(folder.file("scene.xml"), R"(<scene version="3.0.0">
        <integrator type="mote_vpl"><integer name="paths" value="32"/><float name="bound" value="4"/></integrator>
        <shape type="rectangle"/><shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/>
          <translate y="-1" z="1"/></transform></shape>
        <emitter type="point"><point name="position" x="0" y="1" z="2"/></emitter>
        <sensor type="perspective"><transform name="to_world"><lookat origin="0, 2, 5" target="0, -0.5, 0" up="0, 1, 0"/>
          </transform><film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/></film>
        </sensor></scene>)");
    REQUIRE(run_mote(folder, {"render", "scene.xml", "-o", "in.exr", "--passes", "2", "--quiet"}).exit_code ==
            0);
    const RunResult run = run_mote(folder, {"ssbc", "in.exr", "-o", "out.exr", "--scene", "scene.xml"});
    INFO(run.out << run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(total(read_exr(folder.file("out.exr")).rgb("compensation_surface")) > 0.0);
    // Equal compensation from channels, which the render can write too.
    const std::vector<Rgb> from_scene = read_exr(folder.file("out.exr")).rgb("compensation_surface");
    const RunResult render =
        run_mote(folder, {"render", "scene.xml", "-o", "aux.exr", "--passes", "2", "--quiet", "--auxiliary"});
    REQUIRE(render.exit_code == 0);
    const RunResult channels = run_mote(folder, {"ssbc", "aux.exr", "-o", "out.exr"});
    INFO(channels.out << channels.err);
    REQUIRE(channels.exit_code == 0);
    const std::vector<Rgb> from_channels = read_exr(folder.file("out.exr")).rgb("compensation_surface");
    CHECK(total(from_channels) == Approx(total(from_scene)).epsilon(1e-3));
    // Filtered features have no sharp edges: another result, and not the default.
    REQUIRE(run_mote(folder, {"ssbc", "aux.exr", "-o", "out.exr", "--position", "P", "--normal", "N"})
                .exit_code == 0);
    CHECK(total(read_exr(folder.file("out.exr")).rgb("compensation_surface")) < 0.9 * total(from_scene));
    // The film is as large as the picture, whatever the scene says; another camera is noticed.
    const RunResult size = run_mote(
        folder, {"render", "scene.xml", "-o", "in.exr", "--passes", "2", "-D", "film.width=24", "--quiet"});
    REQUIRE(size.exit_code == 0);
    const RunResult other = run_mote(folder, {"ssbc", "in.exr", "-o", "out.exr", "--scene", "scene.xml"});
    INFO(other.err);
    CHECK(other.exit_code == 0);
    CHECK(other.err.empty());
    CHECK(read_exr(folder.file("out.exr")).width == 24);
    std::string moved = read_file(folder.file("scene.xml"));
    moved.replace(moved.find("0, 2, 5"), 7, "0, 2, 6");
    write_file(folder.file("moved.xml"), moved);
    CHECK(contains(run_mote(folder, {"ssbc", "in.exr", "-o", "out.exr", "--scene", "moved.xml"}).err,
                   "the scene's camera is not the one that the picture names"));
}

TEST_CASE("ssbc takes hidden light from a picture, and does its compensation again",
          "[command][ssbc][layers]") {
    const TemporaryFolder folder;
    // Two walls that meet, and a board before one of them.
    write_file(folder.file("scene.xml"), R"(<scene version="3.0.0">
        <integrator type="mote_vpl"><integer name="paths" value="16"/><float name="bound" value="2"/>
          <compensation type="screen_space"><integer name="layers" value="2"/></compensation></integrator>
        <shape type="rectangle"/><shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/>
          <translate y="-1" z="1"/></transform></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="0.3"/><translate y="-0.4" z="1.5"/></transform></shape>
        <emitter type="point"><point name="position" x="0" y="1" z="2"/></emitter>
        <sensor type="perspective"><transform name="to_world"><lookat origin="0, 0.4, 5" target="0, -0.5, 0" up="0, 1, 0"/>
          </transform><film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/></film>
        </sensor></scene>)");
    REQUIRE(run_mote(folder, {"render", "scene.xml", "-o", "in.exr", "--passes", "4", "--quiet"}).exit_code ==
            0);
    const ImageChannels in = read_exr(folder.file("in.exr"));
    const auto ssbc = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"ssbc", "in.exr", "-o", "out.exr"});
        return run_mote(folder, more);
    };
    const RunResult run = ssbc({"--scene", "scene.xml", "--layers", "2", "--replace"});
    INFO(run.out << run.err);
    REQUIRE(run.exit_code == 0);
    const ImageChannels out = read_exr(folder.file("out.exr"));
    CHECK(total(in.rgb("hidden_light_2")) > 0.0);
    CHECK(out.rgb("compensation_surface") == in.rgb("compensation_surface"));
    for (std::size_t i = 0; i < 32 * 24; ++i) CHECK(out.rgb("")[i].y == Approx(in.rgb("")[i].y).margin(1e-6));
    CHECK(contains(out.metadata.at("ssbc"), "layers 2"));

    REQUIRE(ssbc({"--scene", "scene.xml", "--replace"}).exit_code == 0);
    CHECK(total(read_exr(folder.file("out.exr")).rgb("compensation_surface")) <
          0.99 * total(in.rgb("compensation_surface")));
    CHECK(contains(ssbc({"--scene", "scene.xml"}).err, "--replace"));
    CHECK(contains(ssbc({"--layers", "2", "--replace"}).err, "--scene"));
    const RunResult missing = ssbc({"--scene", "scene.xml", "--layers", "3", "--replace"});
    CHECK(missing.exit_code == 1);
    CHECK(contains(missing.err, "hidden_light_3"));
}
