// Mesh files: what OBJ and PLY say, what others damaged, and what a thousand random changes do.
#include "core/formats/meshes/mesh_file.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

using namespace mote::tests;

namespace {

MeshFile obj(const std::string& text) { return read_obj(text, "test.obj", true); }
MeshFile ply(const std::string& text) { return read_ply(text, "test.ply", false); }

const char* const ply_square =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property double z\nproperty float s\nproperty float t\nproperty uchar red\nelement face 1\n"
    "property list uchar int vertex_indices\nelement edge 1\nproperty int a\nproperty int b\nend_header\n"
    "0 0 1 0 0 255\n1 0 1 1 0 255\n1 1 1 1 0.25 0\n0 1 1 0 1 0\n4 0 1 2 3\n0 1\n";

template <typename T>
void put(std::string& out, T value, bool swap) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (swap) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

std::string binary_ply(bool big_endian) {
    std::string out =
        std::string("ply\r\nformat ") + (big_endian ? "binary_big_endian" : "binary_little_endian") +
        " 1.0\r\nelement face 1\r\nproperty list uint8 uint16 vertex_index\r\nelement vertex 3\r\n"
        "property float32 x\r\nproperty float32 y\r\nproperty float64 z\r\nend_header\r\n";
    put(out, std::uint8_t(3), big_endian);
    for (const std::uint16_t i : {0, 1, 2}) put(out, i, big_endian);
    for (int i = 0; i < 3; ++i) {
        put(out, float(i == 1), big_endian), put(out, float(i == 2), big_endian);
        put(out, 7.5, big_endian);
    }
    return out;
}

/// Reads a file; true when it was read, false when it was refused with an InputError that names it.
bool read_or_refuse(const std::string& path, std::string& message) {
    try {
        std::vector<std::string> notes;
        const TriangleMesh loaded(load_mesh(path, false, true, notes));
        CHECK(loaded.area() > 0.0f);
        CHECK_FALSE(loaded.bounds().empty());
        message = std::to_string(loaded.primitive_count()) + " triangles";
        return true;
    } catch (const InputError& error) {
        message = error.what();
        return false;
    }
}

}  // namespace

TEST_CASE("OBJ: indices of three kinds, negative ones, polygons", "[geometry][obj]") {
    const MeshFile file = obj(
        "# comment\nmtllib missing.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\n v\t+1 1e0 0\r\nv 0 1. 0 # corner\n"
        "vt 0 0\nvt 1 0.25\nvn 0 0 2\ns off\nusemtl red\nf 1/1/1 2/2/1 3/2/1 4/1/1\nf -4 -3 \\\n-2\nl 1 2\np "
        "1\n"
        "f 1 2\nf 1//1 2//1 4//1\n");
    const MeshData& data = file.data;
    CHECK(data.triangles.size() == 4);
    CHECK(file.other_dropped == 3);
    CHECK(data.positions.size() == 10);  // distinct triples of indices, in order of first use
    CHECK(data.positions[2] == Vec3(1, 1, 0));
    CHECK(data.uvs[1] == Vec2(1.0f, 0.75f));  // V is flipped
    CHECK(data.normals[0] == Vec3(0, 0, 2));
    CHECK(data.normals[4] == Vec3(0, 0, 0));  // a corner without normal
    CHECK(read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.25\nf 1/1 2/1 3/1", "x.obj", false).data.uvs[0].y ==
          0.25f);
}

TEST_CASE("OBJ: computed normals are smooth only where vertices are shared", "[geometry][obj]") {
    const std::string shared = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\n";
    const std::string split = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 0 1\nf 4 6 5\n";
    const TemporaryFolder folder;
    std::vector<std::string> notes;
    const auto normals = [&](const std::string& text, bool face_normals) {
        const std::string path = folder.file("m.obj");
        std::ofstream(path) << text;
        return load_mesh(path, face_normals, true, notes).normals;
    };
    CHECK(normals(shared, false)[0].z == Approx(std::sqrt(0.5f)));
    CHECK(normals(split, false)[0] == Vec3(0, 0, 1));
    CHECK(normals(shared, true).empty());
}

TEST_CASE("OBJ: faults are refused with their line", "[geometry][obj]") {
    const auto fails = [](const std::string& text, const char* what) {
        CHECK_THROWS_WITH(obj(text), ContainsSubstring(what));
        CHECK_THROWS_AS(obj(text), InputError);
    };
    fails("v 0 0 0\nv 1 0 0\nf 1 2 3\n", "test.obj:3: a face refers to element 3 of 2");
    fails("v 0 0 0\nf 1 0 1\n", "test.obj:2");
    fails("v 0 0 0\nf -2 1 1\n", "element -2");
    fails("v 0 0 0\nf 1/1 1/1 1/1\n", "of 0");
    fails("v 0 0\n", "test.obj:1: expected a number");
    fails("v 0 nan 0\n", "vertex 1 is not finite");
    fails("v 0 1e999 0\n", "not finite");
    fails("v 0 0 0\nf 1 1x 1\n", "malformed index '1x'");
    fails("v 0 0 0\nf 99999999999999999999 1 1\n", "malformed index");
    fails(std::string("v\0 0 0 0\n", 9), "zero bytes");
}

TEST_CASE("PLY: ASCII and both binary orders", "[geometry][ply]") {
    const MeshFile square = ply(ply_square);
    CHECK(square.data.triangles.size() == 2);
    CHECK(square.data.positions[2] == Vec3(1, 1, 1));
    CHECK(square.data.uvs[2] == Vec2(1.0f, 0.25f));  // V is not flipped
    CHECK(square.data.normals.empty());
    for (const bool big_endian : {false, true}) {
        const MeshFile file = ply(binary_ply(big_endian));
        REQUIRE(file.data.positions.size() == 3);
        CHECK(file.data.positions[1] == Vec3(1, 0, 7.5f));
        CHECK(file.data.triangles.at(0) == std::array<std::uint32_t, 3>{0, 1, 2});
    }
}

TEST_CASE("PLY: faults are refused", "[geometry][ply]") {
    const std::string good = ply_square;
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    const auto fails = [](const std::string& text, const char* what) {
        CHECK_THROWS_WITH(ply(text), ContainsSubstring(what));
        CHECK_THROWS_AS(ply(text), InputError);
    };
    fails(with("vertex 4", "vertex 4000000000000"), "too short for 4000000000000 rows");
    fails(with("vertex 4", "vertex 99999999999999999999999"), "malformed count");
    fails(with("face 1", "face 1000000"), "too short");
    fails(with("\n4 0 1", "\n400000 0 1"), "does not fit");
    fails(with("0 1 2 3\n", "0 1 2 9\n"), "refers to vertex 9 of 4");
    fails(with("0 1 2 3\n", "0 1 2 -1\n"), "malformed vertex index");
    fails(with("float x", "float q"), "no x, y and z");
    fails(with("float x", "quad x"), "unknown number type 'quad'");
    fails(with("ascii", "morse"), "unknown PLY format 'morse'");
    fails(with("end_header", "end_heade"), "unknown word");
    fails(with("1 0 1 1", "1 zero 1 1"), "expected a number");
    fails("", "header does not end");
    const std::string binary = binary_ply(false);
    for (std::size_t size = 0; size < binary.size(); ++size)
        CHECK_THROWS_AS(ply(binary.substr(0, size)), InputError);
}

TEST_CASE("files that are not there, or not meshes", "[geometry][mesh_file]") {
    std::vector<std::string> notes;
    CHECK_THROWS_AS(load_mesh("/nowhere/at/all.obj", false, true, notes), InputError);
    CHECK_THROWS_AS(load_mesh("/nowhere/at/all.3ds", false, true, notes), InputError);
    CHECK_THROWS_AS(load_mesh("/", false, true, notes), InputError);
    const TemporaryFolder folder;
    const std::string path = folder.file("bad\nname.obj");
    std::ofstream(path) << "v 0 0 0\n";
    std::string message;
    CHECK_FALSE(read_or_refuse(path, message));
    CHECK_THAT(message, ContainsSubstring("no triangles"));
    CHECK(message.find('\n') == std::string::npos);
}

TEST_CASE("another format, through the child process", "[geometry][mesh_file]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("tetrahedron.off");
    std::ofstream(path) << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    std::vector<std::string> notes;
    const TriangleMesh tetrahedron(load_mesh(path, true, false, notes));
    CHECK(tetrahedron.primitive_count() == 4);
    CHECK(tetrahedron.closed());
    CHECK(tetrahedron.area() == Approx(1.5 + std::sqrt(3.0) / 2.0));
}

TEST_CASE("every damaged mesh is read or refused", "[geometry][mesh_file][damaged]") {
    std::size_t read = 0, refused = 0;
    for (const char* root : {"damaged/assimp", "damaged/tinyobjloader"}) {
        const auto folder = test_data(root);
        if (!folder) return;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
            const std::string extension = entry.path().extension().string();
            if (!entry.is_regular_file() || extension == ".mtl" || extension == ".txt" ||
                entry.path().filename() == "LICENSE")
                continue;
            std::string message;
            const bool ok = read_or_refuse(entry.path().string(), message);
            (ok ? read : refused) += 1;
            CHECK_THAT(message, !ContainsSubstring("\n"));
            if (!ok) CHECK_THAT(message, ContainsSubstring(entry.path().filename().string()));
        }
    }
    std::cout << "damaged meshes: " << read << " read, " << refused << " refused\n";
    CHECK(read > 50);
    CHECK(refused > 15);
}

TEST_CASE("random changes to OBJ and PLY never do more than refuse", "[geometry][mesh_file][damaged]") {
    const std::string originals[] = {
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0.5\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4//1\nf -1 -2 -3\nl 1 "
        "2\n",
        ply_square, binary_ply(false), binary_ply(true)};
    Rng rng(13);
    int read = 0, refused = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = originals[i % 4];
        for (std::uint32_t change = 0; change <= rng.next_u32() % 4; ++change) {
            const std::size_t at = rng.next_u32() % text.size();
            switch (rng.next_u32() % 4) {
                case 0:
                    text[at] = char(rng.next_u32());
                    break;
                case 1:
                    text[at] = "0123456789-/.e \n"[rng.next_u32() % 16];
                    break;
                case 2:
                    text.erase(at, 1 + rng.next_u32() % 8);
                    break;
                default:
                    text.insert(at, 1, "0123456789-/.e \n"[rng.next_u32() % 16]);
            }
            if (text.empty()) text = " ";
        }
        try {
            const TriangleMesh loaded((i % 4 == 0 ? obj(text) : ply(text)).data);
            ++read;
        } catch (const InputError&) {
            ++refused;
        }
    }
    CHECK(read + refused == 20000);
    CHECK(read > 1000);
    CHECK(refused > 1000);
}

TEST_CASE("the bunny and the horse", "[geometry][mesh_file]") {
    const std::filesystem::path models = "/usr/share/glmark2/models";
    for (const char* name : {"bunny.obj", "horse.3ds"}) {
        if (!std::filesystem::exists(models / name)) {
            std::cout << "SKIPPED: no " << name << " (package glmark2-data)\n";
            continue;
        }
        std::vector<std::string> notes;
        const auto model = mesh(load_mesh((models / name).string(), false, true, notes));
        CHECK(model->primitive_count() > 1000);
        const std::shared_ptr<Shape> shapes[] = {model};
        const RayTracer tracer(shapes);
        const Bounds3 box = tracer.bounds();
        CHECK(tracer.closest(ray(box.center() - Vec3(2.0f * box.radius(), 0, 0), {1, 0, 0})));
    }
    if (const auto spot = test_data("meshes/spot/spot_triangulated.obj")) {
        std::vector<std::string> notes;
        const TriangleMesh cow(load_mesh(*spot, false, true, notes));
        CHECK(cow.primitive_count() == 5856);
        CHECK(cow.closed());
        CHECK(cow.notes.empty());
    }
}
