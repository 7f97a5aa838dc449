// Polygons into triangles: a fan where the polygon is convex, ear clipping where it is not.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

/// Appends the triangles of `polygon` (indices into positions, all in range) to `triangles`, keeping its
/// orientation. Polygons of more than 256 corners are cut as fans.
void triangulate_polygon(std::span<const std::uint32_t> polygon, std::span<const Vec3> positions,
                         std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace mote::core
