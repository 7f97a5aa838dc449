// The checks of files, on arrays.
#include "session/array_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/files/checksum.h"
#include "core/geometry/mesh_checks.h"
#include "core/geometry/mesh_edits.h"
#include "core/geometry/shape_plugins.h"
#include "media/grid_volume.h"

namespace mote::session {

using core::InputError, core::MeshData, core::Properties;

namespace {

template <typename Arrays>
const auto& named(const Arrays& arrays, const std::string& name) {
    if (const auto it = arrays.find(name); it != arrays.end()) return it->second;
    std::vector<std::string> known;
    for (const auto& [key, array] : arrays) known.push_back(key);
    throw InputError("there is no array '" + core::printable(name) + "'" + core::suggestion(name, known));
}

void check_free(bool taken, const std::string& name) {
    if (taken) throw InputError("there is an array '" + core::printable(name) + "' already");
}

template <typename T>
void add(std::uint64_t& hash, const std::vector<T>& values) {
    hash = core::checksum(std::as_bytes(std::span(values)), hash);
}

void check_grid(const media::VolFile& grid, const std::string& name) {
    const core::SourceLocation where{"array '" + core::printable(name) + "'", 0};
    const glm::ivec3& n = grid.resolution;
    if (n.x < 1 || n.y < 1 || n.z < 1 || (grid.channels != 1 && grid.channels != 3))
        throw InputError("a grid has at least one voxel along each axis, and one or three channels", where);
    const std::size_t wanted =
        std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z) * std::size_t(grid.channels);
    if (grid.values.size() != wanted)
        throw InputError(fmt::format("{} values where {} x {} x {} voxels of {} channels are {}",
                                     grid.values.size(), n.x, n.y, n.z, grid.channels, wanted),
                         where);
    const auto bad = std::find_if(grid.values.begin(), grid.values.end(),
                                  [](float v) { return !std::isfinite(v) || v < 0.0f; });
    if (bad != grid.values.end())
        throw InputError(fmt::format("value {} is {}: voxels are finite and not negative",
                                     bad - grid.values.begin(), *bad),
                         where);
}

/// As the shapes `ply` and `obj` do with what they read.
std::shared_ptr<core::Object> make_mesh(const Properties& p, const ArrayStore& store) {
    const core::Transform to_world = p.get_transform();
    if (!to_world.valid())
        throw InputError("the transform is singular or not finite", p.where_of("to_world"));
    MeshData data = store.mesh(p.require_string("array"));
    if (p.get_bool("face_normals", false))
        data.normals.clear();
    else if (data.normals.empty())
        core::compute_vertex_normals(data);
    core::transform_mesh(data, to_world);
    if (p.get_bool("flip_normals", false)) core::flip_orientation(data);
    return core::at_element(p, [&] { return std::make_shared<core::TriangleMesh>(std::move(data)); });
}

std::shared_ptr<core::Object> make_grid(const Properties& p, const ArrayStore& store) {
    const std::string name = p.require_string("array");
    const std::vector<std::string> wraps = {"clamp", "repeat", "mirror"};  // as in media::WrapMode
    const std::string wrap = p.get_choice("wrap_mode", "clamp", wraps);
    const auto mode = media::WrapMode(std::find(wraps.begin(), wraps.end(), wrap) - wraps.begin());
    return std::make_shared<media::GridVolume>(store.grid(name), p.get_transform(),
                                               p.get_bool("use_grid_bbox", false), name, mode);
}

}  // namespace

void ArrayStore::add_mesh(const std::string& name, MeshData mesh) {
    check_free(meshes_.contains(name), name);
    const core::SourceLocation where{"array '" + core::printable(name) + "'", 0};
    core::check_mesh(mesh, where);
    if (!core::has_area(mesh)) throw InputError("the mesh has no triangle with an area", where);
    for (const core::Vec3& n : mesh.normals)
        if (!core::is_finite(n)) throw InputError("a normal is not finite", where);
    meshes_.emplace(name, std::move(mesh));
}

void ArrayStore::add_grid(const std::string& name, media::VolFile grid) {
    check_free(grids_.contains(name), name);
    check_grid(grid, name);
    grids_.emplace(name, std::move(grid));
}

const MeshData& ArrayStore::mesh(const std::string& name) const { return named(meshes_, name); }
const media::VolFile& ArrayStore::grid(const std::string& name) const { return named(grids_, name); }

std::string ArrayStore::checksum() const {
    std::uint64_t hash = core::checksum_start;
    for (const auto& [name, mesh] : meshes_)
        add(hash, std::vector<char>(name.begin(), name.end())), add(hash, mesh.positions),
            add(hash, mesh.normals), add(hash, mesh.uvs), add(hash, mesh.triangles);
    for (const auto& [name, grid] : grids_) {
        add(hash, std::vector<char>(name.begin(), name.end())), add(hash, grid.values);
        add(hash, std::vector<int>{grid.resolution.x, grid.resolution.y, grid.resolution.z, grid.channels});
        add(hash, std::vector<core::Vec3>{grid.bounds.lower, grid.bounds.upper});
    }
    return fmt::format("{:016x}", hash);
}

void register_arrays(core::Registry& registry, std::shared_ptr<const ArrayStore> store) {
    registry.add({core::Category::shape,
                  "arraymesh",
                  "Triangles of a host's arrays. Smooth normals are computed when it gives none.",
                  {{"array", "string", "", "name of the arrays"},
                   {"face_normals", "boolean", "false", "drop the normals and compute none: a faceted look"},
                   core::flip_normals_parameter(),
                   core::to_world_parameter("any affine transform; mirroring keeps the outside out")},
                  ""},
                 [store](const Properties& p) { return make_mesh(p, *store); });
    registry.add(
        {core::Category::volume,
         "arraygrid",
         "A dense grid of a host's array; otherwise a `gridvolume`.",
         {{"array", "string", "", "name of the array"},
          {"to_world", "transform", "identity", "Places the unit cube (or the array's box) in the world."},
          {"use_grid_bbox", "boolean", "false", "Use the array's bounding box instead of the unit cube."},
          {"wrap_mode", "string", "clamp", "Outside the grid: clamp, repeat or mirror."}},
         ""},
        [store](const Properties& p) { return make_grid(p, *store); });
}

}  // namespace mote::session
