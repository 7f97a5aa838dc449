// Memory that files will take, by their headers: against the memory that loading takes, and refused before
// any is read.
#include "core/formats/xml/file_memory.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "core/film/image_channels.h"
#include "core/formats/meshes/mesh_file.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/scene_loader.h"
#include "core/geometry/ray_tracer.h"
#include "core/objects/memory_error.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// A PLY file that declares n x n squares of two triangles; with its rows, or without them.
void write_ply(const std::string& path, int n, bool complete = true) {
    std::ofstream out(path, std::ios::binary);
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << (n + 1) * (n + 1)
        << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << 2 * n * n
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    const auto put = [&](const auto& value) {
        out.write(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (int i = 0; i < (n + 1) * (n + 1); ++i) {
        const int x = i % (n + 1), y = i / (n + 1);
        for (const float v : {float(x), float(y), float((x * 7 + y * 5) % 3)}) put(complete ? v : 0.0f);
    }
    for (int i = 0; complete && i < n * n; ++i) {
        const std::int32_t a = i % n + i / n * (n + 1), b = a + 1, c = a + n + 1, d = c + 1;
        for (const auto& corners : {std::array{a, b, c}, std::array{b, d, c}}) {
            put(std::uint8_t(3));
            for (const std::int32_t corner : corners) put(corner);
        }
    }
}

std::string shape(const std::string& file, const std::string& more = "") {
    return fmt::format(R"(<shape type="ply"><string name="filename" value="{}"/>{}</shape>)", file, more);
}
std::string scene_of(const std::string& shapes) {
    return R"(<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"/>)" + shapes +
           "</scene>";
}

std::vector<MemoryOfFile> files_of(const std::string& shapes, const TemporaryFolder& folder) {
    SceneDefines defines({});
    return memory_of_files(read_scene_text(scene_of(shapes), folder.path(), "scene", defines), registry());
}

}  // namespace

TEST_CASE("a mesh takes what its header foretells while it is made, and less than half of it later",
          "[memory][formats]") {
    const TemporaryFolder folder;
    constexpr int n = 300;
    write_ply(folder.file("hills.ply"), n);
    const auto scene = scene_from(scene_of(shape("hills.ply")), 8, folder.path());
    const MeshData& mesh = dynamic_cast<const TriangleMesh&>(*scene->shapes()[0]).data();
    REQUIRE(mesh.triangles.size() == 2 * n * n);
    const RayTracer tracer(scene->shapes());
    const double taken = double(mesh.positions.size() * sizeof(Vec3) + mesh.normals.size() * sizeof(Vec3) +
                                mesh.triangles.size() * sizeof(mesh.triangles[0])) +
                         double(tracer.memory_bytes());
    const double foretold = mesh_file_memory("ply", folder.file("hills.ply"));
    INFO(taken << " and " << foretold << " bytes");
    CHECK(foretold > 2.0 * taken);
    CHECK(foretold < 3.0 * taken);
}

TEST_CASE("files count once for each object that is made of them", "[memory][formats]") {
    const TemporaryFolder folder;
    write_ply(folder.file("a.ply"), 20), write_ply(folder.file("b.ply"), 10);
    const std::string moved = R"(<transform name="to_world"><translate x="1"/></transform>)",
                      red = R"(<bsdf type="diffuse"/>)";
    const auto one = files_of(shape("a.ply"), folder);
    REQUIRE(one.size() == 1);
    CHECK(files_of(shape("a.ply") + shape("a.ply", red), folder)[0].bytes == one[0].bytes);
    CHECK(files_of(shape("a.ply") + shape("a.ply", moved), folder)[0].bytes == 2.0 * one[0].bytes);
    const auto two = files_of(shape("b.ply") + shape("a.ply") + shape("missing.ply"), folder);
    REQUIRE(two.size() == 2);
    CHECK(two[0].path == one[0].path);
    CHECK(two[0].bytes == one[0].bytes);
    CHECK(sum_of(two) == two[0].bytes + two[1].bytes);
    CHECK(memory_summary({{"x/forest.ply", 6.1e9}, {"cloud.vdb", 2.2e9}, {"c", 1e8}, {"d", 1e8}}) ==
          "8.5 GB: forest.ply 6.1 GB, cloud.vdb 2.2 GB, c 0.1 GB, ...");
}

TEST_CASE("files that do not fit are refused before one is read", "[memory][formats]") {
    const TemporaryFolder folder;
    // Long enough for its rows, of which none makes sense.
    write_ply(folder.file("large.ply"), 100, false), write_ply(folder.file("small.ply"), 10);
    std::filesystem::resize_file(folder.file("large.ply"), 1 << 20);
    const std::string text = scene_of(shape("large.ply") + shape("small.ply"));
    LoadOptions options;
    CHECK_THROWS_AS(load_scene_from_string(text, folder.path(), registry(), options), InputError);
    options.memory = MemoryBudget(1e6);
    try {
        load_scene_from_string(text, folder.path(), registry(), options);
        FAIL("3 MB fit into 1 MB");
    } catch (const OutOfMemory& e) {
        INFO(e.what());
        CHECK(std::string(e.what()).find("the files of the scene (3.4 MB): 1.0 MB are available; what fits: "
                                         "all without large.ply") == 0);
    }
    options.memory = MemoryBudget(1e9);
    CHECK_THROWS_AS(load_scene_from_string(text, folder.path(), registry(), options), InputError);
}

TEST_CASE("pictures take what their headers declare, and damaged headers little", "[memory][formats]") {
    const TemporaryFolder folder;
    const std::vector<Rgb> pixels(6 * 4, Rgb(0.5f));
    write_png(folder.file("a.png"), 6, 4, pixels);
    CHECK(bitmap_memory(folder.file("a.png")) == 6 * 4 * 3);
    std::fstream file(folder.file("a.png"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(16), file.write("\x7f\xff\xff\xff\x7f\xff\xff\xff", 8), file.close();
    CHECK(bitmap_memory(folder.file("a.png")) < 1e8);
    std::ofstream(folder.file("b.jpg")) << "\xff\xd8\xff";
    CHECK(bitmap_memory(folder.file("b.jpg")) == 3.0);
}
