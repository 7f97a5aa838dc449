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

/// Everything that the triangles of a mesh follow from: its file's content and what is done to it.
std::string name_of(const std::string& format, const std::string& path, bool face_normals, bool flip_v,
                    bool flip_normals, std::int64_t index, const Transform& to_world) {
    std::string name = fmt::format("{} {:016x} {}{}{} {}", format, checksum(read_whole_file(path)),
                                   face_normals, flip_v, flip_normals, index);
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) name += fmt::format(" {:a}", to_world.matrix[c][r]);
    return name + " " + path;  // errors and notes name the file
}

std::shared_ptr<Object> make_mesh(const Properties& p, MeshCache& kept, const std::string& format,
                                  bool flip_v) {
    const std::string path = p.require_file("filename");
    const bool face_normals = p.get_bool("face_normals", false);
    const Transform to_world = p.get_transform();
    if (!to_world.valid())
        throw InputError("the transform is singular or not finite", p.where_of("to_world"));
    const std::int64_t index = p.get_int_in("shape_index", 0, 0, 0xffffffff);
    const bool flip = p.get_bool("flip_tex_coords", flip_v), flip_normals = p.get_bool("flip_normals", false);
    const auto make = [&] {
        std::vector<std::string> notes;
        MeshData data = load_mesh_as(format, path, face_normals, flip, notes, index);
        transform_mesh(data, to_world);
        if (flip_normals) flip_orientation(data);
        try {
            auto mesh = std::make_shared<TriangleMesh>(std::move(data));
            mesh->notes.insert(mesh->notes.begin(), notes.begin(), notes.end());
            return mesh;
        } catch (const InputError& error) {
            throw InputError(error.what(), {path, 0});
        }
    };
    if (format.empty()) return make();  // may consist of several files
    std::string name;
    try {
        name = name_of(format, path, face_normals, flip, flip_normals, index, to_world);
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    }
    return kept.get(name, make);
}

Manual mesh_manual(const char* type, const char* summary, const char* flip_default, const char* example) {
    return {
        Category::shape,
        type,
        summary,
        {{"filename", "string", "", "the file, relative to the scene file"},
         {"face_normals", "boolean", "false", "drop normals from the file and compute none: a faceted look"},
         {"flip_tex_coords", "boolean", flip_default, "replace texture coordinate v by 1 - v"},
         flip_normals_parameter(),
         to_world_parameter("any affine transform; mirroring keeps the outside out")},
        example};
}

}  // namespace

void register_mesh_files(Registry& registry) {
    const auto kept = std::make_shared<MeshCache>();  // as long as the registry is
    registry.add(mesh_manual("obj",
                             "Triangle mesh from a Wavefront OBJ file. Polygons are triangulated; smooth "
                             "normals are computed when the file has none. Materials in the file are not "
                             "read.",
                             "true", R"(<shape type="obj">
    <string name="filename" value="meshes/cube.obj"/>
    <boolean name="face_normals" value="true"/>
</shape>)"),
                 [kept](const Properties& p) { return make_mesh(p, *kept, "obj", true); });
    registry.add(mesh_manual("ply",
                             "Triangle mesh from a Stanford PLY file, ASCII or binary. Polygons are "
                             "triangulated; smooth normals are computed when the file has none.",
                             "false", R"(<shape type="ply">
    <string name="filename" value="meshes/cube.ply"/>
</shape>)"),
                 [kept](const Properties& p) { return make_mesh(p, *kept, "ply", false); });
    Manual serialized = mesh_manual(
        "serialized",
        "Triangle mesh from a file in Mitsuba's compressed format, version 3 or 4; smooth normals are "
        "computed "
        "when it has none. Colours of vertices are its attribute 'vertex_color' (Mitsuba 3 skips them).",
        "false", R"(<shape type="serialized">
    <string name="filename" value="meshes/cubes.serialized"/>
    <integer name="shape_index" value="1"/>
</shape>)");
    serialized.parameters[2] = {"shape_index", "integer", "0", "which of the file's meshes, from 0"};
    registry.add(std::move(serialized),
                 [kept](const Properties& p) { return make_mesh(p, *kept, "serialized", false); });
    registry.add(mesh_manual("mesh",
                             "Triangle mesh from any file that assimp reads (3ds, stl, off, gltf, ...), all "
                             "its parts in one shape. Mitsuba does not know this type.",
                             "false", R"(<shape type="mesh">
    <string name="filename" value="meshes/cube.off"/>
</shape>)"),
                 [kept](const Properties& p) { return make_mesh(p, *kept, "", false); });
}

}  // namespace mote::core
