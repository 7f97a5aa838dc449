// Shapes "obj", "ply", "serialized" and "mesh": triangle meshes from files.
#include "core/assets/mesh_file.h"
#include "core/assets/register_assets.h"
#include "core/geometry/mesh_edits.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {
namespace {

std::shared_ptr<Object> make_mesh(const Properties& p, const std::string& format, bool flip_v) {
    const std::string path = p.require_file("filename");
    const bool face_normals = p.get_bool("face_normals", false);
    const Transform to_world = p.get_transform();
    if (!to_world.valid())
        throw InputError("the transform is singular or not finite", p.where_of("to_world"));
    std::vector<std::string> notes;
    const std::int64_t index = p.get_int_in("shape_index", 0, 0, 0xffffffff);
    MeshData data =
        load_mesh_as(format, path, face_normals, p.get_bool("flip_tex_coords", flip_v), notes, index);
    transform_mesh(data, to_world);
    if (p.get_bool("flip_normals", false)) flip_orientation(data);
    try {
        auto mesh = std::make_shared<TriangleMesh>(std::move(data));
        mesh->notes.insert(mesh->notes.begin(), notes.begin(), notes.end());
        return mesh;
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    }
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
    registry.add(mesh_manual("obj",
                             "Triangle mesh from a Wavefront OBJ file. Polygons are triangulated; smooth "
                             "normals are computed when the file has none. Materials in the file are not "
                             "read.",
                             "true", R"(<shape type="obj">
    <string name="filename" value="meshes/cube.obj"/>
    <boolean name="face_normals" value="true"/>
</shape>)"),
                 [](const Properties& p) { return make_mesh(p, "obj", true); });
    registry.add(mesh_manual("ply",
                             "Triangle mesh from a Stanford PLY file, ASCII or binary. Polygons are "
                             "triangulated; smooth normals are computed when the file has none.",
                             "false", R"(<shape type="ply">
    <string name="filename" value="meshes/cube.ply"/>
</shape>)"),
                 [](const Properties& p) { return make_mesh(p, "ply", false); });
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
                 [](const Properties& p) { return make_mesh(p, "serialized", false); });
    registry.add(mesh_manual("mesh",
                             "Triangle mesh from any file that assimp reads (3ds, stl, off, gltf, ...), all "
                             "its parts in one shape. Mitsuba does not know this type.",
                             "false", R"(<shape type="mesh">
    <string name="filename" value="meshes/cube.off"/>
</shape>)"),
                 [](const Properties& p) { return make_mesh(p, "", false); });
}

}  // namespace mote::core
