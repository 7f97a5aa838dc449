// Changes to whole meshes before they become shapes: orientation and computed normals.
#pragma once

#include "core/geometry/triangle_mesh.h"

namespace mote::core {

/// Turns the outside in: swaps two corners of every triangle and negates the normals.
void flip_orientation(MeshData& data);

/// Vertex normals as the mean of the adjacent faces' normals weighted by the angle at the vertex (Thuermer &
/// Wuethrich 1998), as Mitsuba computes them for files without normals. Vertices are distinguished by index.
void compute_vertex_normals(MeshData& data);

/// The surface seen from behind, at a distance behind it [m].
MeshData back_side(const MeshData& mesh, float distance);

}  // namespace mote::core
