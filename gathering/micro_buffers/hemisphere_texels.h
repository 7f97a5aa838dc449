// The texels of a micro-buffer: a square of n x n over the hemisphere above a receiver.
//
// Shirley & Chiu's concentric square, (x, y) of [0, 1]^2, raised from the disc to the hemisphere (Nusselt's
// analog): every texel has the same projected solid angle, pi / n^2. Texel (i, j) has the index j n + i; its
// direction is that of its middle, or of another place, the same in all texels. Directions are local, z is
// the receiver's normal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::gathering {

/// Unit direction with z >= 0, for a place in [0, 1]^2.
core::Vec3 square_to_hemisphere(const core::Vec2& square);
/// Its inverse for unit directions with z >= 0; continuous.
core::Vec2 hemisphere_to_square(const core::Vec3& direction);

class HemisphereTexels {
  public:
    /// `place`: where in each texel its direction lies, in [0, 1)^2. Throws InputError for a side of 0, or
    /// above 256.
    explicit HemisphereTexels(std::uint32_t side, const core::Vec2& place = core::Vec2(0.5f));

    std::uint32_t side() const { return side_; }           ///< n: texels along each side
    std::uint32_t count() const { return side_ * side_; }  ///< n^2
    /// Unit, local, one a texel.
    std::span<const core::Vec3> directions() const { return directions_; }
    /// Cosine times solid angle, integrated over a texel [sr]: the sum of it times radiance is irradiance.
    float cosine_weight() const { return float(double(core::pi) / double(side_ * side_)); }

  private:
    std::uint32_t side_;
    std::vector<core::Vec3> directions_;
};

}  // namespace mote::gathering
