// Checks of a mesh before it is used: finite positions, valid indices, triangles with an area, and
// whether its surface is closed.
#pragma once

#include "core/geometry/triangle_mesh.h"
#include "core/objects/error.h"

namespace mote::core {

/// Coordinates beyond this are refused: Embree ignores such triangles without a word.
inline constexpr float largest_coordinate = 1e18f;

/// Throws InputError (at `where`, naming the first offending vertex or triangle) when there is no triangle,
/// an index is out of range, a position is not finite or beyond largest_coordinate, or the normals or texture
/// coordinates do not fit the positions.
void check_mesh(const MeshData& data, const SourceLocation& where);

/// True when at least one triangle has an area (see count_degenerate_triangles). Indices must be in range.
bool has_area(const MeshData& data);

/// Triangles whose corners are collinear as far as double precision shows.
std::size_t count_degenerate_triangles(const MeshData& data);
/// Removes those.
void drop_degenerate_triangles(MeshData& data);

/// True when, after joining vertices at equal positions, every edge is passed as often in one direction as in
/// the other: the surface has no border and its triangles agree on which side is out.
bool is_closed(const MeshData& data);

}  // namespace mote::core
