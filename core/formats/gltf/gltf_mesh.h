// Meshes of a glTF file: the triangles of one primitive.
#pragma once

#include <optional>

#include "core/formats/gltf/gltf_file.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::core {

/// The triangles of meshes[..].primitives[..], in the mesh's own space, with the vertices that they use
/// alone; texture coordinates of set `uv_set`, colours as the attribute "vertex_color" unless they are all
/// white. Nothing where it consists of points or lines. Throws InputError for numbers that are not there.
std::optional<MeshData> read_gltf_primitive(GltfFile& file, const GltfValue& primitive, std::size_t uv_set);

/// The triangles whose picture is seen from in front as it is (u to the right, v down), and those where it is
/// turned over, as on the mirrored half of many models.
struct MeshByHandedness {
    MeshData straight, turned;
};
MeshByHandedness split_by_handedness(const MeshData& mesh);

}  // namespace mote::core
