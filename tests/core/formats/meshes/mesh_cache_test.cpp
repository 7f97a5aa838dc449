// Meshes kept between scenes: read once, the same triangles, made anew when the file or what is done to it
// changes.
#include "core/formats/meshes/mesh_cache.h"

#include <fmt/format.h>

#include <fstream>

#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote::tests;

namespace {

void write_triangle(const std::string& path, float z) {
    std::ofstream(path)
        << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        << "-1 -1 " << z << "\n1 -1 " << z << "\n0 1 " << z << "\n3 0 1 2\n";
}

/// The first shape of a scene with that file, moved along x.
const MeshData& loaded(const TemporaryFolder& folder, float x, std::unique_ptr<Scene>& scene,
                       const std::string& more = "") {
    scene = scene_from(
        fmt::format(R"(<scene version="3.0.0"><shape type="ply"><string name="filename" value="a.ply"/>
        <transform name="to_world"><translate x="{}"/></transform>{}</shape><emitter type="constant"/>
        <sensor type="perspective"/></scene>)",
                    x, more),
        8, folder.path());
    return dynamic_cast<const TriangleMesh&>(*scene->shapes()[0]).data();
}

}  // namespace

TEST_CASE("a mesh is kept while it is requested", "[geometry][mesh_cache]") {
    MeshCache cache;
    int made = 0;
    const auto get = [&](const std::string& name) {
        return cache.get(name, [&] {
            ++made;
            return mesh(one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, float(made)}));
        });
    };
    const auto a = get("a"), again = get("a");
    CHECK(made == 1);
    CHECK(a != again);
    CHECK(&a->data() == &again->data());  // in memory once
    a->id = "attached";
    CHECK(get("a")->id.empty());
    // Frames with one mesh that stays and one of their own: each is loaded while the one before is still
    // held.
    std::vector<std::shared_ptr<TriangleMesh>> before;
    for (int frame = 0; frame < 50; ++frame) {
        std::vector<std::shared_ptr<TriangleMesh>> now{get("a"), get("of frame " + std::to_string(frame))};
        before = now;
    }
    CHECK(made == 51);
    CHECK(cache.size() < 5);
    CHECK_THROWS(cache.get("wrong", []() -> std::shared_ptr<TriangleMesh> { throw InputError("no"); }));
    CHECK(get("wrong"));
}

TEST_CASE("scenes that are loaded one after the other share meshes that have not changed",
          "[geometry][mesh_cache]") {
    const TemporaryFolder folder;
    write_triangle(folder.file("a.ply"), 0.0f);
    std::unique_ptr<Scene> first, second, moved, turned, changed;
    const MeshData& data = loaded(folder, 0.0f, first);
    CHECK(&loaded(folder, 0.0f, second) == &data);
    CHECK(first->shapes()[0] != second->shapes()[0]);
    CHECK(first->shapes()[0]->bsdf != second->shapes()[0]->bsdf);
    const MeshData& there = loaded(folder, 2.0f, moved);
    CHECK(&there != &data);
    CHECK(there.positions[1].x == 3.0f);
    CHECK(&loaded(folder, 0.0f, turned, R"(<boolean name="flip_normals" value="true"/>)") != &data);
    write_triangle(folder.file("a.ply"), 5.0f);
    CHECK(loaded(folder, 0.0f, changed).positions[0].z == 5.0f);
}
