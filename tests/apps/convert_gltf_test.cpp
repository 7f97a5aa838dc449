// glTF scenes on the command line: render, info and plan take them; convert turns them into XML.
#include <filesystem>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/core/formats/gltf/gltf_builder.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using namespace mote::core;
namespace fs = std::filesystem;

namespace {

GltfBuilder lamp_and_wall() {
    GltfBuilder b;
    nlohmann::json wall = {{"name", "Wall"}, {"doubleSided", true}};
    wall["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0.5, 0.9, 0.9, 1}},
        {"metallicFactor", 0},
        {"baseColorTexture", {{"index", b.texture(2, 1, {200, 10, 10, 10, 200, 10})}}}};
    const nlohmann::json glow = {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}};
    b.node({{"mesh", b.mesh(gltf_quad(), wall)}});
    b.node({{"mesh", b.mesh(gltf_quad(), glow)}, {"translation", {0, 0, 2}}, {"scale", {0.2, 0.2, 0.2}}});
    b.camera({{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"aspectRatio", 1}, {"znear", 0.1}}}},
             {{"name", "Eye"}, {"translation", {0, 0, 4}}});
    return b;
}

const std::vector<std::string> quick = {"--quiet",  "-D", "film.width=8", "-D", "film.height=8",
                                        "--passes", "4"};

RunResult render(const TemporaryFolder& folder, const std::string& scene, const std::string& output) {
    std::vector<std::string> arguments = {"render", scene, "-o", output};
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    return run_mote(folder, arguments);
}
std::vector<Rgb> pixels(const TemporaryFolder& folder, const std::string& name) {
    return read_exr(folder.file(name)).rgb("");
}
bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("mote convert: the XML renders as the glTF does, to the bit", "[command][gltf]") {
    const TemporaryFolder folder;
    write_file(folder.file("room.glb"), lamp_and_wall().binary());
    const RunResult rendered = render(folder, "room.glb", "a.exr");
    INFO(rendered.err);
    REQUIRE(rendered.exit_code == 0);
    const RunResult converted = run_mote(folder, {"convert", "room.glb", "out.xml"});
    INFO(converted.err);
    REQUIRE(converted.exit_code == 0);
    CHECK(converted.out == "out.xml\nout_files\n");
    fs::remove(folder.file("room.glb"));  // the result stands alone, wherever it is
    fs::create_directory(folder.file("moved"));
    fs::rename(folder.file("out.xml"), folder.file("moved/out.xml"));
    fs::rename(folder.file("out_files"), folder.file("moved/out_files"));
    REQUIRE(render(folder, "moved/out.xml", "b.exr").exit_code == 0);
    CHECK(pixels(folder, "a.exr") == pixels(folder, "b.exr"));
    CHECK(pixels(folder, "a.exr")[2 * 8 + 2].y > 0.0f);
    CHECK(contains(run_mote(folder, {"info", "moved/out.xml"}).out, "2 area"));
}

TEST_CASE("mote convert refuses a glTF scene as a whole, or takes what it can", "[command][gltf]") {
    const TemporaryFolder folder;
    GltfBuilder b = lamp_and_wall();
    b.document["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"] = 1;
    write_file(folder.file("room.gltf"), b.text());
    const RunResult refused = run_mote(folder, {"convert", "room.gltf", "out.xml"});
    CHECK(refused.exit_code == 1);
    CHECK(
        refused.err ==
        "mote: room.gltf: materials[0] 'Wall' uses KHR_materials_clearcoat, which has no counterpart here\n");
    CHECK(!fs::exists(folder.file("out.xml")));
    CHECK(!fs::exists(folder.file("out_files")));
    const RunResult lenient = run_mote(folder, {"convert", "room.gltf", "out.xml", "--lenient"});
    CHECK(lenient.exit_code == 0);
    CHECK(contains(lenient.err, "no counterpart here: left out"));
    const RunResult info = run_mote(folder, {"info", "room.gltf", "--lenient"});
    CHECK(contains(info.out, "scene room.gltf"));
    CHECK(contains(info.out, "lenient     room.gltf: materials[0] 'Wall'"));
}

TEST_CASE("mote convert: cameras, wrong words, files that must stay", "[command][gltf]") {
    const TemporaryFolder folder;
    GltfBuilder b = lamp_and_wall();
    fs::create_directory(folder.file("out_files"));
    write_png(folder.file("out_files/texture_0.png"), 1, 1, std::vector<Rgb>(1, Rgb(0.5f)));
    b.document["images"][0] = {{"uri", "out_files/texture_0.png"}};
    write_file(folder.file("room.gltf"), b.text());
    const auto refusal = [&](std::vector<std::string> arguments, int exit_code) {
        const RunResult run = run_mote(folder, arguments);
        CHECK(run.exit_code == exit_code);
        CHECK(!fs::exists(folder.file("out.xml")));
        return run.err;
    };
    const std::string png = read_file(folder.file("out_files/texture_0.png"));
    CHECK(contains(refusal({"convert", "room.gltf", "out.xml"}, 1), "would replace"));
    CHECK(read_file(folder.file("out_files/texture_0.png")) == png);
    CHECK(contains(refusal({"convert", "room.gltf", "out.xml", "-D", "camera=Ey"}, 1), "did you mean 'Eye'"));
    CHECK(contains(refusal({"convert", "room.gltf", "out.xml", "-D", "size=3"}, 2), "camera=NAME"));
    CHECK(contains(refusal({"convert", "room.gltf", "out.png"}, 2), "from .gltf, .glb or .pbrt to .xml"));
    CHECK(contains(refusal({"convert", "out_files/texture_0.png", "out.xml"}, 2),
                   "from .gltf, .glb or .pbrt to .xml"));
    CHECK(contains(refusal({"convert", "room.gltf", "out.xml", "--half"}, 2), "are for pictures"));
    CHECK(contains(refusal({"export", "room.gltf", "--to", "mitsuba3", "-o", "folder"}, 1), "mote convert"));
    CHECK(contains(refusal({"render", "room.gltf", "-o", "a.exr", "-D", "emission=-1"}, 1),
                   "must not be negative"));
}
