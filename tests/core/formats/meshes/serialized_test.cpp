// Mitsuba's serialized meshes: both versions and precisions, several in a file, and files that lie.
#include <zlib.h>

#include <cstring>

#include "core/formats/meshes/mesh_file.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

template <typename T>
void put(std::string& out, T value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string packed(const std::string& bytes) {
    uLongf size = compressBound(uLong(bytes.size()));
    std::string out(size, '\0');
    REQUIRE(compress(reinterpret_cast<Bytef*>(out.data()), &size,
                     reinterpret_cast<const Bytef*>(bytes.data()), uLong(bytes.size())) == Z_OK);
    out.resize(size);
    return out;
}

constexpr std::uint32_t normals = 1, uvs = 2, colours = 8, face_normals = 16, floats = 0x1000,
                        doubles = 0x2000;

/// A triangle whose corners are `size` away from the origin, with whatever the flags say.
std::string mesh_bytes(int version, std::uint32_t flags, double size, std::uint64_t vertices = 3,
                       std::uint64_t triangles = 1, const std::string& name = "a") {
    std::string raw;
    put(raw, flags);
    if (version == 4) raw += name + '\0';
    put(raw, vertices), put(raw, triangles);
    const auto number = [&](double value) {
        if (flags & doubles)
            put(raw, value);
        else
            put(raw, float(value));
    };
    for (int i = 0; i < 3; ++i)
        for (int axis = 0; axis < 3; ++axis) number(axis == i ? size : 0.0);
    for (int i = 0; i < 3 && flags & normals; ++i) number(0), number(0), number(1);
    for (int i = 0; i < 3 && flags & uvs; ++i) number(0.25 * i), number(1 - 0.5 * i);
    for (int i = 0; i < 3 && flags & colours; ++i) number(0.1 * i), number(0.5), number(1);
    for (const std::uint32_t corner : {0u, 1u, 2u}) put(raw, corner);
    std::string out;
    put(out, std::uint16_t(0x041c)), put(out, std::uint16_t(version));
    return out + packed(raw);
}

std::string file_of(int version, const std::vector<std::string>& meshes) {
    std::string out;
    std::vector<std::size_t> offsets;
    for (const std::string& mesh : meshes) offsets.push_back(out.size()), out += mesh;
    for (const std::size_t offset : offsets) {
        if (version == 4)
            put(out, std::uint64_t(offset));
        else
            put(out, std::uint32_t(offset));
    }
    put(out, std::uint32_t(meshes.size()));
    return out;
}

MeshFile read(const std::string& bytes, std::int64_t index = 0) {
    return read_serialized(bytes, "x.serialized", index);
}

}  // namespace

TEST_CASE("serialized meshes of both versions and precisions", "[assets][serialized]") {
    const int version = GENERATE(3, 4);
    const std::uint32_t precision = GENERATE(floats, doubles);
    const std::string bytes = file_of(version, {mesh_bytes(version, precision | normals | uvs | colours, 1.0),
                                                mesh_bytes(version, precision | face_normals, 2.0),
                                                mesh_bytes(version, precision | uvs, 3.0)});
    const MeshData full = read(bytes).data;
    CHECK(full.positions == std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    CHECK(full.normals == std::vector<Vec3>(3, Vec3(0, 0, 1)));
    CHECK(full.uvs == std::vector<Vec2>{{0, 1}, {0.25f, 0.5f}, {0.5f, 0}});
    CHECK(full.triangles.size() == 1);
    REQUIRE(full.attributes.size() == 1);
    CHECK(full.attributes[0].name == "vertex_color");
    CHECK(full.attributes[0].values[2].x == Approx(0.2));
    const MeshFile second = read(bytes, 1);
    CHECK(second.data.positions[0].x == 2.0f);
    CHECK(second.data.normals.empty());
    REQUIRE(second.notes.size() == 1);
    CHECK_THAT(second.notes[0], ContainsSubstring("face_normals"));
    CHECK(read(bytes, 2).data.positions[1].y == 3.0f);
    CHECK(read(bytes, 2).data.uvs.size() == 3);
    CHECK_THROWS_WITH(read(bytes, 3),
                      ContainsSubstring("x.serialized: there is no mesh 3: the file holds 3"));
}

TEST_CASE("serialized files that lie are refused by name", "[assets][serialized]") {
    const std::string good = file_of(4, {mesh_bytes(4, floats, 1.0), mesh_bytes(4, floats, 2.0)});
    CHECK_THROWS_WITH(read(""), ContainsSubstring("x.serialized: not a file of serialized meshes"));
    CHECK_THROWS_WITH(read("solid cube"), ContainsSubstring("not a file"));
    std::string other = good;
    other[2] = 5;
    CHECK_THROWS_WITH(read(other), ContainsSubstring("version 5"));
    // Sizes beyond what the file can hold take no memory.
    for (const std::uint64_t count : {std::uint64_t(1) << 20, std::uint64_t(1) << 31, ~std::uint64_t(0)}) {
        CHECK_THROWS_WITH(read(mesh_bytes(4, floats, 1.0, count, 1)), ContainsSubstring("too"));
        CHECK_THROWS_WITH(read(mesh_bytes(4, doubles, 1.0, 3, count)), ContainsSubstring("too"));
    }
    // A stream that unpacks to a thousand times its size: 300 MB of zeros in 300 kB.
    std::string bomb;
    put(bomb, std::uint32_t(floats)), bomb += '\0';
    put(bomb, std::uint64_t(25000000)), put(bomb, std::uint64_t(1));
    bomb.resize(bomb.size() + 20000000);
    CHECK_THROWS_WITH(read(std::string("\x1c\x04\x04\x00", 4) + packed(bomb)),
                      ContainsSubstring("too short"));
    CHECK_THROWS_WITH(read(mesh_bytes(4, floats, 1.0, 3, 1, std::string(10000, 'n'))),
                      ContainsSubstring("name"));
    // Cut off anywhere, and with any byte changed: an error or a mesh, never more.
    int refused = 0;
    for (std::size_t size = 0; size < good.size(); ++size) try {
            read(good.substr(0, size));
        } catch (const InputError&) {
            ++refused;
        }
    // All that ends within the first mesh, but for the checksum at its end.
    const int short_ones = refused;
    CHECK(short_ones + 6 >= int(mesh_bytes(4, floats, 1.0).size()));
    for (std::size_t i = 0; i < good.size(); ++i)
        for (const std::int64_t index : {0, 1}) {
            std::string damaged = good;
            damaged[i] = char(damaged[i] ^ 0x55);
            try {
                read(damaged, index);
            } catch (const InputError& error) {
                CHECK_THAT(std::string(error.what()), ContainsSubstring("x.serialized"));
                ++refused;
            }
        }
    CHECK(refused > short_ones + 40);
}

TEST_CASE("PLY files carry attributes by Mitsuba's names", "[assets][attributes]") {
    const MeshData data =
        read_ply(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
            "property float foo_x\nproperty float foo_y\nproperty float foo_z\nproperty float heat_0\n"
            "property float lone\nelement face 2\nproperty list uchar int vertex_indices\n"
            "property float r\nproperty float g\nproperty float b\nproperty float bar_r\nproperty float "
            "bar_g\n"
            "property float bar_b\nend_header\n"
            "0 0 0 255 0 51 255 1 2 3 7 0\n1 0 0 0 255 51 255 1 2 4 8 0\n1 1 0 0 0 51 255 1 2 5 9 0\n"
            "0 1 0 0 0 51 255 1 2 6 10 0\n4 0 1 2 3 0.1 0.2 0.3 1 2 3\n3 0 1 2 0.4 0.5 0.6 4 5 6\n",
            "test.ply", false)
            .data;
    const auto mesh = mote::tests::mesh(data);
    const SurfaceAttributes* attributes = mesh->attributes();
    REQUIRE(attributes);
    for (const char* name : {"vertex_color", "vertex_foo", "vertex_heat", "face_color", "face_bar_color"}) {
        INFO(name);
        CHECK(attributes->has_attribute(name));
    }
    CHECK_FALSE(attributes->has_attribute("vertex_lone"));
    CHECK(data.attributes.size() == 5);
    // Integers are fractions of 255; the quad became two triangles with the same face's colour.
    CHECK(attributes->attribute("vertex_color", 0, {0, 0}) == Rgb(1, 0, 0.2f));
    CHECK(attributes->attribute("face_color", 0, {0.3f, 0.3f}) == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(attributes->attribute("face_color", 1, {0.3f, 0.3f}) == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(attributes->attribute("face_color", 2, {0.3f, 0.3f}) == Rgb(0.4f, 0.5f, 0.6f));
    CHECK(attributes->attribute_range("vertex_heat") == Vec2(7, 10));
    // Weighted by area: two triangles of the quad, and one of the same size.
    CHECK(attributes->attribute_mean("face_color").x == Approx(0.2));
    // A ray finds the interpolated value; so does a point sampled.
    const std::shared_ptr<Shape> shapes[] = {mesh};
    const RayTracer tracer(shapes);
    const auto hit = tracer.closest(ray({0.25f, 0.75f, 1}, {0, 0, -1}));
    REQUIRE(hit);
    const float z = hit->uv.attributes->attribute("vertex_foo", hit->uv.primitive, hit->uv.barycentric).z;
    CHECK(z == Approx(3 + 0.25 * 2 + 0.5 * 3).margin(1e-5));  // bilinear here: 3, 4, 5, 6 around the square
    const ShapeSample sample = mesh->sample_area({0.1f, 0.4f});
    CHECK(sample.uv.attributes == attributes);
}

TEST_CASE("faces without area take their attributes with them", "[assets][attributes]") {
    MeshData data = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    data.triangles = {{0, 1, 2}, {0, 1, 1}, {0, 2, 1}};
    data.attributes = {{"face_color", true, {Rgb(1), Rgb(2), Rgb(3)}}};
    const auto mesh = mote::tests::mesh(data);
    REQUIRE(mesh->primitive_count() == 2);
    CHECK(mesh->attributes()->attribute("face_color", 1, {0, 0}).x == 3.0f);
    data.attributes[0].values.pop_back();
    CHECK_THROWS_WITH(mote::tests::mesh(data), ContainsSubstring("face_color"));
}
