// load_mesh(): chooses the reader, then repairs or refuses what all formats have in common.
#include "core/formats/meshes/mesh_file.h"

#include <algorithm>
#include <filesystem>

#include "core/files/whole_file.h"
#include "core/geometry/mesh_checks.h"
#include "core/geometry/mesh_edits.h"

namespace mote::core {
namespace {

std::string format_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension.empty() ? "" : extension.substr(1);
}

MeshFile read_mesh_file(const std::string& format, const std::string& path, bool flip_v,
                        std::int64_t shape_index) {
    if (format != "obj" && format != "ply" && format != "serialized") return read_with_assimp(path, flip_v);
    std::vector<std::byte> bytes;
    try {
        bytes = read_whole_file(path);
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (format == "serialized") return read_serialized(text, path, shape_index);
    return format == "obj" ? read_obj(std::string(text), path, flip_v) : read_ply(text, path, flip_v);
}

std::string counted(std::size_t n, const char* singular, const char* plural, const char* what) {
    return std::to_string(n) + " " + (n == 1 ? singular : plural) + " " + what;
}

/// Normals and texture coordinates that are not finite become zero, which means "none".
void repair(MeshData& data, std::vector<std::string>& notes) {
    std::size_t normals = 0, uvs = 0;
    for (Vec3& n : data.normals)
        if (!is_finite(n) || !is_finite(glm::dot(n, n))) n = Vec3(0.0f), ++normals;
    for (Vec2& uv : data.uvs)
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = Vec2(0.0f), ++uvs;
    if (normals > 0)
        notes.push_back(counted(normals, "normal", "normals", "not finite, replaced by the face's"));
    if (uvs > 0)
        notes.push_back(counted(uvs, "texture coordinate", "texture coordinates", "not finite, set to zero"));
}

}  // namespace

MeshData load_mesh_as(const std::string& format, const std::string& path, bool face_normals, bool flip_v,
                      std::vector<std::string>& notes, std::int64_t shape_index) {
    MeshFile file = read_mesh_file(format.empty() ? format_of(path) : format, path, flip_v, shape_index);
    notes.insert(notes.end(), file.notes.begin(), file.notes.end());
    MeshData& data = file.data;
    check_mesh(data, {path, 0});
    if (!has_area(data)) throw InputError("the mesh has no triangle with an area", {path, 0});
    if (file.other_dropped > 0)
        notes.push_back(counted(file.other_dropped, "line or point", "lines or points", "dropped"));
    if (face_normals) {
        data.normals.clear();
    } else if (data.normals.empty()) {
        compute_vertex_normals(data);
    }
    repair(data, notes);
    return std::move(data);
}

MeshData load_mesh(const std::string& path, bool face_normals, bool flip_v, std::vector<std::string>& notes) {
    return load_mesh_as("", path, face_normals, flip_v, notes);
}

}  // namespace mote::core
