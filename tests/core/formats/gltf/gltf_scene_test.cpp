// glTF scenes: the same picture as the scene that says the same in our language, units, cameras, materials,
// and reports of what has no counterpart.
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/formats/conversion/scratch_folder.h"
#include "core/formats/meshes/ply_writer.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/faults.h"
#include "core/formats/xml/scene_loader.h"
#include "core/materials/bsdf.h"
#include "tests/core/formats/gltf/gltf_builder.h"
#include "tests/core/scene/scene_fixture.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;
using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using nlohmann::json;

namespace {

void write(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::unique_ptr<Scene> load_text(const std::string& text, LoadOptions options = {},
                                 const std::string& name = "scene.gltf") {
    const TemporaryFolder folder;
    write(folder.file(name), text);
    return load_scene(folder.file(name), mote::tests::registry(), options);
}

std::string error_of_file(const std::string& path) {
    try {
        load_scene(path, mote::tests::registry());
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string error_of(const std::string& text, const LoadOptions& options = {}) {
    try {
        load_text(text, options);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// Means of the picture's pixels, one after the other, by `path`.
RenderStatistics picture(const Scene& scene, std::uint32_t passes = 4) {
    const auto integrator =
        integrator_from("<integrator type='path'><integer name='max_depth' value='3'/></integrator>");
    return render_statistics(scene, *integrator, {.block = 1, .passes = passes});
}
std::vector<double> means(const RenderStatistics& r) {
    std::vector<double> all;
    for (const Estimate& e : r.blocks[r.layer("beauty")]) all.push_back(e.mean);
    return all;
}
double mean_of(const Scene& scene, std::uint32_t passes = 4) {
    const RenderStatistics r = picture(scene, passes);
    return r.whole[r.layer("beauty")][0].mean;
}

const json small_camera = {{"type", "perspective"},
                           {"perspective", {{"yfov", 0.5}, {"aspectRatio", 1.0}, {"znear", 0.1}}}};
const json flat_camera = {{"type", "orthographic"},
                          {"orthographic", {{"xmag", 0.5}, {"ymag", 0.5}, {"znear", 0.1}, {"zfar", 100}}}};
const LoadOptions small = [] {
    LoadOptions options;
    options.defines = {{"film.width", "12"}, {"film.height", "12"}};
    return options;
}();

json dull(const json& colour) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", colour}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}};
}

/// A floor with a picture on it, a triangle and its mirror image, three lights and a camera.
GltfBuilder room() {
    GltfBuilder b;
    json wood = dull({1, 1, 1, 1});
    wood["pbrMetallicRoughness"]["baseColorTexture"]["index"] =
        b.texture(2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255});
    wood["doubleSided"] = true;
    b.node({{"mesh", b.mesh(gltf_quad(), wood)}, {"scale", {3, 2, 1}}});
    MeshData triangle{{{0, 0, 0.5f}, {1, 0, 0.5f}, {0, 1, 1}}, {}, {}, {{{0, 1, 2}}}, {}};
    const std::size_t mesh = b.mesh(triangle, dull({0.5, 0.6, 0.7, 1}));
    b.node({{"mesh", mesh}});
    b.node({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
    b.camera(small_camera, {{"name", "Eye"}, {"translation", {0, 0, 8}}});
    b.light({{"type", "point"}, {"intensity", 6830}}, {{"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}});
    b.light({{"type", "directional"}, {"intensity", 683}, {"color", {1, 0.5, 0.25}}},
            {{"rotation", {std::sin(0.25), 0, 0, std::cos(0.25)}}});
    b.light({{"type", "spot"},
             {"intensity", 13660},
             {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.3}}}},
            {{"translation", {-1, -1, 4}}});
    return b;
}

/// Scene of the same room in XML, written by hand.
std::string room_xml() {
    const double s = std::sin(0.5), c = std::cos(0.5);
    const std::string dull_bsdf =
        R"(<float name="roughness" value="1"/><float name="eta" value="1.5"/><float name="metallic" value="0"/>)";
    const std::string wing =
        R"(<string name="filename" value="wing.ply"/><boolean name="face_normals" value="true"/>
        <bsdf type="principled"><rgb name="base_color" value="0.5, 0.6, 0.7"/>)" +
        dull_bsdf + "</bsdf></shape>";
    return R"(<scene version="3.0.0"><integrator type="path"/>
    <sensor type="perspective"><float name="fov" value=")" +
           std::to_string(0.5 * 180.0 / 3.14159265358979) + R"("/>
        <string name="fov_axis" value="y"/><float name="near_clip" value="0.1"/>
        <transform name="to_world"><lookat origin="0, 0, 8" target="0, 0, 7" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="12"/></film>
        <sampler type="sobol"/></sensor>
    <shape type="ply"><string name="filename" value="floor.ply"/>
        <transform name="to_world"><scale x="3" y="2" z="1"/></transform>
        <bsdf type="twosided"><bsdf type="principled"><texture type="bitmap" name="base_color">
            <string name="filename" value="wood.png"/></texture>)" +
           dull_bsdf + R"(</bsdf></bsdf></shape>
    <shape type="ply">)" +
           wing + R"(
    <shape type="ply"><transform name="to_world"><scale x="-1"/></transform>)" +
           wing + R"(
    <emitter type="point"><point name="position" x="1" y="2" z="3"/><rgb name="intensity" value="10"/></emitter>
    <emitter type="directional"><vector name="direction" x="0" y=")" +
           std::to_string(s) + R"(" z=")" + std::to_string(-c) +
           R"("/><rgb name="irradiance" value="1, 0.5, 0.25"/></emitter>
    <emitter type="spot"><transform name="to_world"><lookat origin="-1, -1, 4" target="-1, -1, 0" up="0, 1, 0"/></transform>
        <rgb name="intensity" value="20"/><float name="cutoff_angle" value="17.188734"/>
        <float name="beam_width" value="5.729578"/></emitter></scene>)";
}

}  // namespace

TEST_CASE("A glTF scene and the same scene in XML have one picture", "[gltf]") {
    const TemporaryFolder folder;
    write(folder.file("floor.ply"), ply_bytes(gltf_quad()));
    write(folder.file("wing.ply"),
          ply_bytes({{{0, 0, 0.5f}, {1, 0, 0.5f}, {0, 1, 1}}, {}, {}, {{{0, 1, 2}}}, {}}));
    const auto png =
        encode_png(2, 2, std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}, true);
    write(folder.file("wood.png"), {reinterpret_cast<const char*>(png.data()), png.size()});
    const auto xml = load_scene_from_string(room_xml(), folder.path(), mote::tests::registry());
    const auto text = load_text(room().text(), small),
               binary = load_text(room().binary(), small, "scene.GLB");
    CHECK(text->shapes().size() == 3);
    CHECK(text->emitters().size() == 3);
    const std::vector<double> a = means(picture(*xml)), b = means(picture(*text));
    CHECK(b == means(picture(*binary)));  // the same bits
    double largest = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, a[i]), difference = std::max(difference, std::fabs(a[i] - b[i]));
    CHECK(largest > 0.1);
    CHECK(difference < 1e-5 * largest);  // angles in the XML are rounded
    // Planted: the mirrored triangle where it was not mirrored.
    GltfBuilder planted = room();
    planted.document["nodes"][2].erase("scale");
    CHECK(means(picture(*load_text(planted.text(), small))) != b);
}

TEST_CASE("glTF lights: candela, lux and candela a square metre over 683", "[gltf]") {
    const auto scene = load_text(room().text(), small);
    const auto power = [&](std::size_t i) { return double(scene->emitters()[i]->power().x); };
    CHECK_THAT(power(0), WithinRel(40.0 * M_PI, 1e-5));
    GltfBuilder lamp;
    json glow = {{"emissiveFactor", {1, 0, 0}},
                 {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1366}}}}}};
    lamp.node({{"mesh", lamp.mesh(gltf_quad(), glow)}});
    CHECK_THAT(load_text(lamp.text(), small)->emitters()[0]->power().x,
               WithinRel(2.0f * 4.0f * float(M_PI), 1e-4f));
    LoadOptions brighter = small;
    brighter.defines.emplace_back("emission", "683");
    CHECK_THAT(load_text(lamp.text(), brighter)->emitters()[0]->power().x,
               WithinRel(683.0f * 8.0f * float(M_PI), 1e-4f));
    // A picture of light, times the factor.
    glow["emissiveTexture"]["index"] = lamp.texture(1, 1, {255, 255, 255});
    lamp.document["materials"][0] = glow;
    CHECK_THAT(load_text(lamp.text(), small)->emitters()[0]->power().x, WithinRel(8.0f * float(M_PI), 1e-4f));
}

TEST_CASE("A double-sided glTF lamp shines to both sides", "[gltf]") {
    GltfBuilder b;
    const json glow = {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}};
    b.node({{"mesh", b.mesh(gltf_quad(), glow)}, {"translation", {0, 0, 100}}});
    b.camera(flat_camera, {{"translation", {0, 0, 110}}});
    b.camera(flat_camera, {{"name", "behind"}, {"translation", {0, 0, 90}}, {"rotation", {0, 1, 0, 0}}});
    LoadOptions options = small;
    options.defines.emplace_back("emission", "683");
    const auto in_front = load_text(b.text(), options);
    CHECK(in_front->shapes().size() == 2);
    CHECK_THAT(mean_of(*in_front), WithinRel(1.0, 1e-5));
    options.defines.emplace_back("camera", "behind");
    CHECK_THAT(mean_of(*load_text(b.text(), options)), WithinRel(1.0, 1e-5));
}

TEST_CASE("glTF cameras are chosen by name, and stand in where there is none", "[gltf]") {
    GltfBuilder b;
    b.node({{"mesh", b.mesh(gltf_quad(), dull({1, 1, 1, 1}))}});
    const auto overview = load_text(b.text(), small);
    CHECK(mean_of(*overview) > 0.1);  // it shows something, in the light that stands in
    const auto whole = load_text(b.text());
    double lowest = 1e9, highest = 0.0;
    for (const Vec3& corner : gltf_quad().positions) {  // all of it, and large
        const auto place = whole->camera().project(corner);
        REQUIRE(place);
        lowest = std::min(lowest, double(place->y)), highest = std::max(highest, double(place->y));
    }
    CHECK(highest - lowest > 0.8 * whole->film().height);
    REQUIRE(overview->parts().warnings.size() == 2);
    contains(overview->parts().warnings[0], "no camera");
    contains(overview->parts().warnings[1], "no light");
    b.camera(flat_camera, {{"name", "Front"}, {"translation", {0, 0, 5}}});
    b.camera(small_camera, {{"name", "Side"}, {"translation", {0, 0, 9}}});
    LoadOptions options = small;
    contains(load_text(b.text(), options)->parts().warnings[0], "-D camera=NAME chooses: Front, Side");
    options.defines.emplace_back("camera", "Sied");
    contains(error_of(b.text(), options), "has no camera 'Sied' (did you mean 'Side'?)");
    options.defines.back().second = "Side";
    CHECK(load_text(b.text(), options)->film().width == 12);
    // The film has the camera's shape.
    b.document["cameras"][0]["orthographic"]["xmag"] = 1.0;
    CHECK(load_text(b.text())->film().width == 2 * load_text(b.text())->film().height);
}

TEST_CASE("Holes and panes of glTF materials", "[gltf]") {
    const auto brightness = [](const json& extra) {
        GltfBuilder b;
        json material = dull({0, 0, 0, 0.25});
        material["doubleSided"] = true;
        material.update(extra);
        b.node({{"mesh", b.mesh(gltf_quad(), material)}});
        b.camera(flat_camera, {{"translation", {0, 0, 5}}});
        return mean_of(*load_text(b.text(), small), 256);
    };
    const double opaque = brightness(json::object());
    GltfBuilder windows;
    json pane = dull({0.5, 1, 1, 1});
    pane["pbrMetallicRoughness"]["roughnessFactor"] = 0;
    pane["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
    windows.node({{"mesh", windows.mesh(gltf_quad(), pane)}});
    windows.camera(flat_camera, {{"translation", {0, 0, 5}}});
    const auto window = load_text(windows.text(), small);
    CHECK(window->integrator()->type() == "volpath");
    // A pane of index 1.5 reflects 2 R / (1 + R) = 1/13, and lets the rest through in the colour.
    CHECK_THAT(mean_of(*window, 64), WithinAbs(1.0 / 13.0 + 0.5 * 12.0 / 13.0, 0.02));
    CHECK(opaque < 0.2);  // the black floor's reflection alone
    CHECK(brightness({{"alphaMode", "MASK"}}) == 1.0);
    CHECK(brightness({{"alphaMode", "MASK"}, {"alphaCutoff", 0.2}}) == opaque);
    CHECK_THAT(brightness({{"alphaMode", "BLEND"}}), WithinAbs(0.75 + 0.25 * opaque, 0.01));
}

TEST_CASE("Normal maps on mirrored glTF nodes are mirrored too", "[gltf]") {
    // Tilted up and to the right, lit from above and the right; then all of it mirrored.
    const auto brightness = [](double side, double light) {
        GltfBuilder b;
        json bumpy = dull({0.5, 0.5, 0.5, 1});
        bumpy["normalTexture"]["index"] = b.texture(1, 1, {190, 200, 220});
        b.node({{"mesh", b.mesh(gltf_quad(), bumpy)}, {"scale", {side, 1, 1}}});
        b.camera(flat_camera, {{"translation", {0, 0, 5}}});
        // Half a turn of 0.6 about an axis in the picture's plane: the light comes from above and the right.
        b.light({{"type", "directional"}, {"intensity", 683}},
                {{"rotation", {-0.3, light * 0.3, 0, std::sqrt(1 - 0.18)}}});
        return mean_of(*load_text(b.text(), small));
    };
    const double right = brightness(1, 1);
    CHECK_THAT(brightness(-1, -1), WithinRel(right, 1e-3));
    CHECK_THAT(brightness(-1, 1), WithinRel(brightness(1, -1), 1e-3));
    CHECK(right > 1.1 * brightness(1, -1));
}

TEST_CASE("glTF texture transforms scale, turn the picture clockwise, and move it", "[gltf]") {
    // Red, of a picture that is black otherwise, in the quarters of the square: left to right, top to bottom.
    const auto red_in = [](const json& transform) {
        GltfBuilder b;
        json light = {{"emissiveFactor", {1, 1, 1}}};
        light["emissiveTexture"]["index"] = b.texture(2, 2, {255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
        light["emissiveTexture"]["extensions"]["KHR_texture_transform"] = transform;
        b.document["textures"][0]["sampler"] = b.add("samplers", {{"magFilter", 9728}});
        b.node({{"mesh", b.mesh(gltf_quad(), light)}});
        b.camera({{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}}}},
                 {{"translation", {0, 0, 5}}});
        LoadOptions options;
        options.defines = {{"film.width", "2"}, {"film.height", "2"}, {"emission", "683"}};
        const auto scene = load_text(b.text(), options);
        scene->film().filter = "box";
        const RenderStatistics r = picture(*scene, 64);
        std::string where;
        for (std::size_t i = 0; i < 4; ++i)
            where += r.blocks[r.layer("beauty")][3 * i].mean > 0.5 ? 'r' : '-';
        return where;
    };
    CHECK(red_in(json::object()) == "r---");
    CHECK(red_in({{"rotation", M_PI / 2}}) == "-r--");
    CHECK(red_in({{"offset", {0.5, 0}}}) == "-r--");
    CHECK(red_in({{"offset", {0, 0.5}}}) == "--r-");
    CHECK(red_in({{"scale", {0.5, 0.5}}}) == "rrrr");
    // Scaled along v before it is turned.
    CHECK(red_in({{"scale", {1, 0.5}}, {"rotation", M_PI / 2}}) == "-r-r");
}

TEST_CASE("Colours of vertices are multiplied by the material's", "[gltf]") {
    GltfBuilder b;
    const std::size_t mesh = b.mesh(gltf_quad(), dull({0.5, 0.25, 1, 1}));
    b.document["meshes"][mesh]["primitives"][0]["attributes"]["COLOR_0"] =
        b.floats(std::vector<float>(12, 0.5f), "VEC3", 3);
    b.node({{"mesh", mesh}});
    const auto scene = load_text(b.text(), small);
    const SurfaceAttributes* attributes = scene->shapes()[0]->attributes();
    REQUIRE(attributes);
    CHECK(attributes->attribute("vertex_color", 0, {0.2f, 0.3f}) == Rgb(0.25f, 0.125f, 0.5f));
    CHECK(scene->shapes()[0]->bsdf->traits().textured);
}

TEST_CASE("Meshes of many glTF nodes are instances", "[gltf]") {
    GltfBuilder b;
    const std::size_t mesh = b.mesh(gltf_quad(), dull({1, 1, 1, 1}));
    for (int i = 0; i < 3; ++i) b.node({{"mesh", mesh}, {"translation", {0, 0, i}}});
    b.node({{"children", {b.add("nodes", {{"mesh", mesh}, {"scale", {0.5, 0.5, 0.5}}})}},
            {"translation", {5, 0, 0}}});
    const auto scene = load_text(b.text(), small);
    CHECK(scene->shapes().size() == 4);
    CHECK_THAT(scene->shapes()[3]->bounds().lower.x, WithinRel(4.5f, 1e-5f));
    CHECK(!scene->shapes()[0]->emitter);
}

TEST_CASE("What has no counterpart in glTF files is reported at once, and left out with leniency", "[gltf]") {
    GltfBuilder b;
    json coated = dull({1, 1, 1, 1});
    coated["name"] = "Coat";
    coated["extensions"] = {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}},
                            {"KHR_materials_sheen", {{"sheenColorFactor", {0, 0, 0}}}}};
    b.node({{"mesh", b.mesh(gltf_quad(), coated)}, {"skin", 0}});
    b.document["extensionsUsed"] = {"KHR_materials_clearcoat", "EXT_unheard"};
    try {
        load_text(b.text(), small);
        FAIL("a clearcoat was accepted");
    } catch (const SceneErrors& errors) {
        REQUIRE(errors.all().size() == 2);  // sheen is switched off
        contains(errors.all()[0].what(), "scene.gltf: nodes[0] is a skin");
        contains(errors.all()[1].what(), "materials[0] 'Coat' uses KHR_materials_clearcoat");
    }
    LoadReport report;
    LoadOptions lenient = small;
    lenient.lenient = true, lenient.report = &report;
    const auto scene = load_text(b.text(), lenient);
    CHECK(report.approximations.size() == 2);
    contains(report.approximations[1], "no counterpart here: left out");
    contains(scene->parts().warnings[0], "EXT_unheard is not known");
}

TEST_CASE("A glTF scene holds the names of the files it was read from, and no temporary ones", "[gltf]") {
    const TemporaryFolder folder;
    GltfBuilder b;
    json wood = dull({1, 1, 1, 1});
    b.add("images", {{"uri", "my%20wood.png"}});
    b.add("textures", {{"source", 0}});
    wood["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    b.node({{"mesh", b.mesh(gltf_quad(), wood)}});
    write(folder.file("scene.gltf"), b.text());
    CHECK(file_error(folder.file("scene.gltf")).find("file 'my wood.png' was not found") !=
          std::string::npos);
    write_png(folder.file("my wood.png"), 1, 1, std::vector<Rgb>(1, Rgb(0.5f)));
    const auto scene = load_scene(folder.file("scene.gltf"), mote::tests::registry());
    CHECK(scene->parts().input_files ==
          std::vector<std::string>{folder.file("scene.gltf"), folder.file("my wood.png")});
    write(folder.file("my wood.png"), "no picture");
    const std::string error = error_of_file(folder.file("scene.gltf"));
    contains(error, "my wood.png");
    contains(error, "not a picture of a known kind");
}

TEST_CASE("A scratch folder goes with the process, however that ends", "[gltf]") {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const ScratchFolder scratch;
        write(scratch.path() + "/file", "text");
        [[maybe_unused]] const auto written = ::write(ends[1], scratch.path().c_str(), scratch.path().size());
        ::kill(::getpid(), SIGKILL);
    }
    ::close(ends[1]);
    char name[4096] = {};
    REQUIRE(::read(ends[0], name, sizeof(name) - 1) > 0);
    ::waitpid(child, nullptr, 0);
    ::close(ends[0]);
    for (int i = 0; i < 1000 && std::filesystem::exists(name); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK(!std::filesystem::exists(name));
}
