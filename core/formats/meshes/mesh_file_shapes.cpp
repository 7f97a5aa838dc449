// Shapes "obj", "ply", "serialized" and "mesh": triangle meshes from files.
#include <fmt/format.h>

#include "core/files/checksum.h"
#include "core/files/whole_file.h"
#include "core/formats/meshes/mesh_cache.h"
#include "core/formats/meshes/mesh_file.h"
#include "core/formats/register_formats.h"
#include "core/geometry/mesh_edits.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {
namespace {

struct MeshFileSettings : ShapePlacement {
    FileName file;
    bool face_normals = false, flip_v = false;
    std::uint32_t shape_index = 0;
};

/// Everything that the triangles of a mesh follow from: its file's content and what is done to it.
std::string name_of(const std::string& format, const MeshFileSettings& s) {
    std::string name = fmt::format("{} {:016x} {}{}{} {}", format, checksum(read_whole_file(s.file.path)),
                                   s.face_normals, s.flip_v, s.flip_normals, s.shape_index);
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) name += fmt::format(" {:a}", s.to_world.matrix[c][r]);
    return name + " " + s.file.path;  // errors and notes name the file
}

std::shared_ptr<TriangleMesh> make_mesh(const std::string& format, const MeshFileSettings& s) {
    std::vector<std::string> notes;
    MeshData data = load_mesh_as(format, s.file.path, s.face_normals, s.flip_v, notes, s.shape_index);
    transform_mesh(data, s.to_world);
    if (s.flip_normals) flip_orientation(data);
    try {
        auto mesh = std::make_shared<TriangleMesh>(std::move(data));
        mesh->notes.insert(mesh->notes.begin(), notes.begin(), notes.end());
        return mesh;
    } catch (const InputError& error) {
        throw InputError(error.what(), {s.file.path, 0});
    }
}

std::shared_ptr<Object> make_or_reuse(const std::string& format, const MeshFileSettings& s, MeshCache& kept) {
    if (format.empty()) return make_mesh(format, s);  // may consist of several files
    std::string name;
    try {
        name = name_of(format, s);
    } catch (const InputError& error) {
        throw InputError(error.what(), {s.file.path, 0});
    }
    return kept.get(name, [&] { return make_mesh(format, s); });
}

const Rows<MeshFileSettings> index_row =
    row("shape_index", &MeshFileSettings::shape_index, "Which of the file's meshes, from 0.");
const Rows<MeshFileSettings> flip_row =
    row("flip_tex_coords", &MeshFileSettings::flip_v, "Replace texture coordinate v by 1 - v.");

/// The rows of a format, of which one is its own.
ParameterList<MeshFileSettings> mesh_rows(const Rows<MeshFileSettings>& own, bool flip_v = false) {
    MeshFileSettings defaults;
    defaults.flip_v = flip_v;
    return {defaults,
            {row("filename", &MeshFileSettings::file, "The file, relative to the scene file.").required(),
             row("face_normals", &MeshFileSettings::face_normals,
                 "Drop normals from the file and compute none: a faceted look."),
             own, placement_rows("Any affine transform; mirroring keeps the outside out.")}};
}

}  // namespace

void register_mesh_files(Registry& registry) {
    const auto add = [&, kept = std::make_shared<MeshCache>()](  // as long as the registry is
                         const std::string& type, const std::string& format, const std::string& summary,
                         const ParameterList<MeshFileSettings>& rows, const std::string& example) {
        add_type(registry, Category::shape, type, summary, rows, example,
                 [kept, format](const MeshFileSettings& s) { return make_or_reuse(format, s, *kept); });
        registry.set_file_memory(Category::shape, type, [format](const Properties& p) {
            return mesh_file_memory(format, p.find_file("filename"));
        });
    };
    add("obj", "obj",
        "Triangle mesh from a Wavefront OBJ file. Polygons are triangulated; smooth normals are computed "
        "when the file has none. Materials in the file are not read.",
        mesh_rows(flip_row, true), R"(<shape type="obj">
    <string name="filename" value="meshes/cube.obj"/>
    <boolean name="face_normals" value="true"/>
</shape>)");
    add("ply", "ply",
        "Triangle mesh from a Stanford PLY file, ASCII or binary. Polygons are triangulated; smooth normals "
        "are computed when the file has none.",
        mesh_rows(flip_row), R"(<shape type="ply">
    <string name="filename" value="meshes/cube.ply"/>
</shape>)");
    add("serialized", "serialized",
        "Triangle mesh from a file in Mitsuba's compressed format, version 3 or 4; smooth normals are "
        "computed when it has none. Colours of vertices are its attribute 'vertex_color' (Mitsuba 3 skips "
        "them).",
        mesh_rows(index_row), R"(<shape type="serialized">
    <string name="filename" value="meshes/cubes.serialized"/>
    <integer name="shape_index" value="1"/>
</shape>)");
    add("mesh", "",
        "Triangle mesh from any file that assimp reads (3ds, stl, off, gltf, ...), all its parts in one "
        "shape. Mitsuba has no such type.",
        mesh_rows(flip_row), R"(<shape type="mesh">
    <string name="filename" value="meshes/cube.off"/>
</shape>)");
}

}  // namespace mote::core
