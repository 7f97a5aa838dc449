// The texels of a micro-buffer: a square of n x n over the hemisphere above a receiver.
//
// Both maps go through Shirley & Chiu's concentric square, (x, y) of [0, 1]^2. Texel (i, j) is number j n +
// i; its direction is that of its middle, or of another place, the same in all texels. Directions are local,
// z is the receiver's normal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::gathering {

/// How the square is laid over the hemisphere.
enum class HemisphereMap : std::uint8_t {
    cosine,     ///< Nusselt's analog: every texel has the same projected solid angle, pi / n^2
    equal_area  ///< every texel has the same solid angle, 2 pi / n^2
};

/// Unit direction with z >= 0, for a place in [0, 1]^2.
core::Vec3 square_to_hemisphere(HemisphereMap map, const core::Vec2& square);
/// Its inverse for unit directions with z >= 0; continuous.
core::Vec2 hemisphere_to_square(HemisphereMap map, const core::Vec3& direction);

class HemisphereTexels {
  public:
    /// `place`: where in each texel its direction lies, in [0, 1)^2. Throws InputError for a side of 0, or
    /// above 256.
    HemisphereTexels(HemisphereMap map, std::uint32_t side, const core::Vec2& place = core::Vec2(0.5f));

    HemisphereMap map() const { return map_; }             ///< how the square is laid over them
    std::uint32_t side() const { return side_; }           ///< n: texels along each side
    std::uint32_t count() const { return side_ * side_; }  ///< n^2
    /// Unit, local, one a texel.
    std::span<const core::Vec3> directions() const { return directions_; }
    /// Cosine times solid angle, integrated over the texel: they sum to pi [sr]. Sum of weight times radiance
    /// is the irradiance.
    std::span<const float> cosine_weights() const { return cosine_weights_; }
    /// Integrated over the texel: they sum to 2 pi [sr].
    std::span<const float> solid_angles() const { return solid_angles_; }

  private:
    HemisphereMap map_;
    std::uint32_t side_;
    std::vector<core::Vec3> directions_;
    std::vector<float> cosine_weights_, solid_angles_;
};

}  // namespace mote::gathering
