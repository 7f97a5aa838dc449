// Makes an indexed mesh of a triangle soup: equal corners are welded, normals are smoothed except over
// creases.
#pragma once

#include <cstdint>
#include <filesystem>

#include "tools/geometry/soup.h"

namespace mote::tools {

struct IndexedMesh {
    std::vector<Vec3> positions, normals;  ///< as many normals as positions, of length 1
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Triangles without area (below 1e-12 m^2, or thinner than a millionth of their length) are left out. The
/// normal of a corner is the mean, weighted by area, of the faces around the point that lie within
/// `crease_degrees` of its own face. Throws std::logic_error for a position that is not finite.
IndexedMesh weld(const Soup& soup, float crease_degrees = 35.0f);

/// Binary PLY, little-endian, with normals; written beside the final name and renamed. Throws
/// core::InputError when the file cannot be written.
void write_ply(const std::filesystem::path& path, const IndexedMesh& mesh);

}  // namespace mote::tools
