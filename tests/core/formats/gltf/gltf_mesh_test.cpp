// Accessors in all their layouts, and triangles from primitives.
#include <fstream>

#include "core/formats/gltf/gltf_accessor.h"
#include "core/formats/gltf/gltf_mesh.h"
#include "tests/core/formats/gltf/gltf_builder.h"
#include "tests/core/scene/scene_fixture.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;
using nlohmann::json;

namespace {

/// The first primitive of the first mesh.
std::optional<MeshData> read(GltfBuilder& b, std::size_t uv_set = 0) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("mesh.gltf")) << b.text();
    GltfFile file(folder.file("mesh.gltf"));
    return read_gltf_primitive(file, file.root()["meshes"].at(0)["primitives"].at(0), uv_set);
}
std::string refusal(GltfBuilder& b) {
    try {
        read(b);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
const std::vector<float> zigzag = {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0};

GltfBuilder zigzag_of(int mode) {
    GltfBuilder b;
    b.add("meshes",
          {{"primitives", {{{"attributes", {{"POSITION", b.floats(zigzag, "VEC3", 3)}}}, {"mode", mode}}}}});
    return b;
}

}  // namespace

TEST_CASE("glTF strips and fans keep their orientation", "[gltf]") {
    GltfBuilder strip = zigzag_of(5), fan = zigzag_of(6), list = zigzag_of(4), points = zigzag_of(0);
    CHECK(read(list)->triangles == Triangles{{0, 1, 2}});
    CHECK(!read(points));
    const auto turns = [](const MeshData& m, std::size_t i) {
        const auto& t = m.triangles[i];
        const Vec3 a = m.positions[t[0]], b = m.positions[t[1]], c = m.positions[t[2]];
        return glm::cross(b - a, c - a).z;
    };
    const auto s = read(strip), f = read(fan);
    REQUIRE(s->triangles.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(turns(*s, i) < 0.0f);  // all as the first
    REQUIRE(f->triangles.size() == 3);
    CHECK(f->positions[f->triangles[2][2]] == Vec3(0.0f));  // all share the first corner
}

TEST_CASE("glTF accessors: strides, normalized integers, sparse values", "[gltf]") {
    GltfBuilder b;
    // Position and colour side by side: 12 bytes and 4.
    struct Vertex {
        float p[3];
        std::uint8_t c[4];
    };
    const std::vector<Vertex> vertices = {
        {{0, 0, 0}, {255, 0, 51, 255}}, {{1, 0, 0}, {0, 255, 0, 255}}, {{0, 1, 0}, {0, 0, 255, 0}}};
    const std::size_t view = b.view(vertices.data(), sizeof(Vertex) * 3);
    b.document["bufferViews"][view]["byteStride"] = sizeof(Vertex);
    const auto position =
        b.add("accessors", {{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
    const auto colour = b.add("accessors", {{"bufferView", view},
                                            {"byteOffset", 12},
                                            {"componentType", 5121},
                                            {"normalized", true},
                                            {"type", "VEC4"},
                                            {"count", 3}});
    const std::vector<std::int16_t> halves = {0, 0, 32767, -32767, 0, 0};
    const auto uv = b.accessor(halves, 5122, "VEC2", 2);
    b.document["accessors"][uv]["normalized"] = true;
    b.add("meshes",
          {{"primitives",
            {{{"attributes", {{"POSITION", position}, {"COLOR_0", colour}, {"TEXCOORD_1", uv}}}}}}});
    auto mesh = read(b, 1);
    REQUIRE(mesh);
    CHECK(mesh->positions[2] == Vec3(0, 1, 0));
    CHECK(mesh->uvs[1] == Vec2(1, -1));
    REQUIRE(mesh->attributes.size() == 1);
    CHECK(mesh->attributes[0].values[0] == Rgb(1.0f, 0.0f, 0.2f));

    const std::vector<std::uint8_t> places = {2};
    const std::vector<float> moved = {7, 8, 9};
    b.document["accessors"][position]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", b.view(places.data(), 1)}, {"componentType", 5121}}},
        {"values", {{"bufferView", b.view(moved.data(), 12)}}}};
    mesh = read(b, 1);
    CHECK(mesh->positions[2] == Vec3(7, 8, 9));
    CHECK(mesh->positions[1] == Vec3(1, 0, 0));
}

TEST_CASE("Primitives keep the vertices that they use", "[gltf]") {
    GltfBuilder b = zigzag_of(4);
    b.document["meshes"][0]["primitives"][0]["indices"] =
        b.accessor(std::vector<std::uint32_t>{4, 3, 2}, 5125, "SCALAR", 1);
    const auto mesh = read(b);
    CHECK(mesh->positions.size() == 3);
    CHECK(mesh->positions[mesh->triangles[0][0]] == Vec3(2, 0, 0));
}

TEST_CASE("Numbers that are not there are refused by name", "[gltf]") {
    GltfBuilder b = zigzag_of(4);
    b.document["accessors"][0]["count"] = 6;
    contains(refusal(b), "accessors[0]: has 6 elements that reach beyond their bufferView");
    b = zigzag_of(4);
    b.document["bufferViews"][0]["byteLength"] = 61;
    contains(refusal(b), "bufferViews[0]: reaches beyond its buffer");
    b = zigzag_of(4);
    b.document["meshes"][0]["primitives"][0]["indices"] =
        b.accessor(std::vector<std::uint16_t>{0, 1, 5}, 5123, "SCALAR", 1);
    contains(refusal(b), "name a vertex that is not there");
    b = zigzag_of(4);
    b.document["accessors"][0]["bufferView"] = 3;
    contains(refusal(b), "accessors[0].bufferView: is 3, but there are 1");
    b = zigzag_of(9);
    contains(refusal(b), "mode: is no kind of primitive");
    b = zigzag_of(4);
    b.document["accessors"][0]["count"] = "five";
    contains(refusal(b), "accessors[0].count: is no whole number");
    b = zigzag_of(4);
    b.document["asset"]["version"] = "1.0";
    contains(refusal(b), "asset.version: is '1.0': only glTF 2 is read");
}

TEST_CASE("Triangles are distinguished by how they show a picture", "[gltf]") {
    MeshData mesh = gltf_quad();
    CHECK(split_by_handedness(mesh).turned.triangles.empty());
    mesh.positions.emplace_back(-1, 3, 0), mesh.normals.emplace_back(0, 0, 1), mesh.uvs.emplace_back(0, 1);
    mesh.triangles.push_back({3, 2, 4});  // the picture continues upside down
    const MeshByHandedness parts = split_by_handedness(mesh);
    CHECK(parts.straight.triangles.size() == 2);
    REQUIRE(parts.turned.triangles.size() == 1);
    CHECK(parts.turned.positions.size() == 3);
    CHECK(parts.turned.positions[parts.turned.triangles[0][2]] == Vec3(-1, 3, 0));
}
