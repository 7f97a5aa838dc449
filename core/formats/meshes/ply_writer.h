// Triangle meshes as PLY files.
#pragma once

#include <string>

#include "core/geometry/triangle_mesh.h"

namespace mote::core {

/// A little-endian PLY file, with Mitsuba's names for normals, texture coordinates and
/// attributes.
std::string ply_bytes(const MeshData& mesh);

}  // namespace mote::core
