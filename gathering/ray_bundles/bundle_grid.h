// The rays of a bundle: a regular grid across a direction.
#pragma once

#include <cstdint>

#include "core/math/bounds.h"

namespace mote::gathering {

/// The rays. Ray (x, y) begins at `origin` + (x + 1/2) spacing `right` + (y + 1/2) spacing `up`, outside of
/// the bounds that the grid was made for, and represents the area spacing^2 perpendicular to `direction`.
/// Its number is y * columns + x.
struct BundleGrid {
    core::Vec3 direction{0, 0, 1};           ///< unit
    core::Vec3 right{1, 0, 0}, up{0, 1, 0};  ///< right x up = direction
    core::Vec3 origin{0, 0, 0};              ///< of the grid's corner [m]
    float spacing = 1.0f;                    ///< [m]
    std::uint32_t columns = 0, rows = 0;     ///< of rays

    std::size_t rays() const { return std::size_t(columns) * rows; }  ///< all of them
    float ray_area() const { return spacing * spacing; }              ///< [m^2]
    /// Where a ray of the grid begins [m].
    core::Vec3 ray_origin(std::uint32_t x, std::uint32_t y) const {
        return origin + spacing * ((float(x) + 0.5f) * right + (float(y) + 0.5f) * up);
    }
};

/// A grid that covers `bounds` whatever its offset: at least one column or row of rays lies on or beyond each
/// side. With `offset` uniform over [0,1)^2, what a bundle finds on average over offsets is the integral over
/// all parallel rays, without bias. Empty bounds give a grid without rays. Throws InputError for a direction
/// or bounds that are not finite, a spacing that is not positive, and more than 2^31 rays, naming a spacing
/// that fits.
BundleGrid bundle_grid(const core::Vec3& direction, const core::Bounds3& bounds, float spacing,
                       const core::Vec2& offset);

/// Surfaces nearer to each other along the rays than this may have changed places by rounding: a few units in
/// the last place of the distances and coordinates [m].
float coincidence(const BundleGrid& grid, const core::Bounds3& bounds);

}  // namespace mote::gathering
