// The pinhole camera of a picture, found from the positions that its pixels show.
//
// Files say where the camera stands (worldToCamera of OpenEXR), but few say its field of view. Positions do:
// in camera space, column = c_x + f_x X / Z and row = c_y + f_y Y / Z, two straight lines to be fitted. How
// well they fit also shows whether the positions are in that space at all.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/math/vec.h"

namespace mote::screenspace {

struct FittedCamera {
    core::Vec3d eye{0.0}, forward{0.0};  ///< in the space of the positions; forward has unit length
    double pixel_area = 0.0;             ///< of a pixel on the film at distance 1
    double error = 0.0;  ///< root mean square of what is left between pixels and the fit [pixels]
};

/// Sixteen numbers, for row vectors: (x, y, z, 1) times the matrix is in camera space, z forward or backward.
using RowMatrix = std::array<double, 16>;

/// `shown`: 1 where a pixel has a position. Nothing where too few have for lines to be fitted, or the matrix
/// is singular. In a picture of one column or row pixels are taken for squares.
std::optional<FittedCamera> fit_camera(int width, int height, std::span<const core::Vec3> position,
                                       std::span<const std::uint8_t> shown, const RowMatrix& to_camera);

}  // namespace mote::screenspace
