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

struct ArrayMesh : core::ShapePlacement {
    std::string array;
    bool face_normals = false;
};

/// As the shapes `ply` and `obj` do with what they read.
std::shared_ptr<core::Object> make_mesh(const ArrayMesh& s, const Properties& p, const ArrayStore& store) {
    MeshData data = store.mesh(s.array);
    if (s.face_normals)
        data.normals.clear();
    else if (data.normals.empty())
        core::compute_vertex_normals(data);
    core::transform_mesh(data, s.to_world);
    if (s.flip_normals) core::flip_orientation(data);
    return core::at_element(p, [&] { return std::make_shared<core::TriangleMesh>(std::move(data)); });
}

struct ArrayGrid : media::GridPlacement {
    std::string array;
};

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
    using namespace core;
    add_type<ArrayMesh>(
        registry, Category::shape, "arraymesh",
        "Triangles of a host's arrays. Smooth normals are computed when it gives none.",
        {row("array", &ArrayMesh::array, "Name of the arrays.").required(),
         row("face_normals", &ArrayMesh::face_normals, "Drop the normals and compute none: a faceted look."),
         placement_rows("Any affine transform; mirroring keeps the outside out.")},
        "", [store](const ArrayMesh& s, const Properties& p) { return make_mesh(s, p, *store); });
    add_type<ArrayGrid>(
        registry, Category::volume, "arraygrid", "A dense grid of a host's array; otherwise a `gridvolume`.",
        {row("array", &ArrayGrid::array, "Name of the array.").required(), media::grid_placement_rows()}, "",
        [store](const ArrayGrid& s) {
            return std::make_shared<media::GridVolume>(store->grid(s.array), s.to_world, s.use_grid_bbox,
                                                       s.array, s.wrap);
        });
}

}  // namespace mote::session
