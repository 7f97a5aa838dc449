// Radiance over all directions from a latitude-longitude picture: lookup, and sampling in proportion to it.
//
// y is up; u = atan2(x, -z) / 2 pi and v = acos(y) / pi. As in Mitsuba 3, column i of W has its centre at
// u = (i + 1/2) / W and wraps around, row j of H lies at v = j / (H - 1), so that the first and the last row
// are the poles. Between, the lookup is bilinear.
#pragma once

#include "core/formats/pictures/image_file.h"
#include "core/math/distribution.h"
#include "core/objects/error.h"

namespace mote::lights {

class EnvironmentPicture {
  public:
    /// Pixels must be finite and not negative (see check_pixels).
    explicit EnvironmentPicture(core::Bitmap picture);

    /// Radiance from the unit direction d.
    core::Rgb eval(const core::Vec3& d) const;

    struct Sample {
        core::Vec3 direction;
        float pdf_solid_angle;
    };
    /// Precondition: !black(). Density in proportion to the mean luminance of the cell between four pixels:
    /// zero only where all four corners are black, and so everything between them.
    Sample sample(const core::Vec2& u) const;
    float pdf_solid_angle(const core::Vec3& d) const;

    /// Exact integral of eval() over the sphere.
    core::Rgb integral() const { return integral_; }
    bool black() const { return distribution_.empty(); }

  private:
    /// A direction in units of cells: whole parts choose the cell, fractions the place within it.
    core::Vec2 cell_coordinates(const core::Vec3& d) const;
    const core::Rgb& pixel(int column, int row) const;
    float cell_solid_angle(int row) const;

    core::Bitmap picture_;
    int columns_, rows_;                 ///< of cells: W by H - 1, at least one
    std::vector<float> cosines_;         ///< cos(theta) at the rows' borders, rows_ + 1 entries
    core::Distribution2D distribution_;  ///< power of each cell; y runs with cos(theta) within a cell
    core::Rgb integral_{0.0f};
};

/// Throws InputError, with the count and the first position, when a pixel is NaN, infinite or negative, and
/// when there are none.
void check_pixels(const core::Bitmap& picture, const std::string& name,
                  const core::SourceLocation& where = {});

}  // namespace mote::lights
