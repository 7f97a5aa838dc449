// Shapes of pbrt scenes as triangle meshes, in the space of the object.
#pragma once

#include "core/formats/pbrt/pbrt_parameters.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::core {

/// "trianglemesh". Triangles are turned to the side of their normals, as pbrt takes them.
MeshData pbrt_triangle_mesh(const PbrtObject& shape);
/// "bilinearmesh": two triangles for a parallelogram, 8 x 8 squares for other patches.
MeshData pbrt_bilinear_mesh(const PbrtObject& shape);
/// "loopsubdiv": the refined mesh with its vertices moved to the limit surface, and smooth normals.
MeshData pbrt_loop_subdivision(const PbrtObject& shape);
/// "sphere", "cylinder" and "disk" that are cut off, or deformed by their transform.
MeshData pbrt_quadric(const PbrtObject& shape);

/// Swaps corners of triangles whose normal points away from those of their vertices.
void turn_to_normals(MeshData& mesh);
double mesh_area(const MeshData& mesh);

}  // namespace mote::core
