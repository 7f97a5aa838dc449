// Maps of texels over all directions, and over one hemisphere, on the octahedron (Engelhardt 2013, Ch. 7):
// plain structs for loops that look up millions of directions a second.
//
// Texels are numbered row by row. z is up: the middle of the square looks along +z, its four corners along
// -z. The border that Fig. 7.5 stores around the map is arithmetic here: a footprint names the texel that a
// border texel would be a copy of, so the memory holds nothing twice. Directions need not have unit length,
// but must not be zero. A NaN in a direction leads to texels of the map with weights that are NaN.
#pragma once

#include <array>

#include "core/math/octahedral.h"

namespace mote::lights {

/// Texels and weights of a bilinear lookup: the weights add up to one.
struct BilinearFootprint {
    std::array<int, 4> texel;
    std::array<float, 4> weight;
};

/// A place between texel centres: the cell's lower corner, in [-1, size - 1], and the fractions within it.
struct TexelCell {
    int i, j;
    float s, t;

    /// `uv` in [0, 1]^2. The order of the arguments lets min and max turn NaN into 0, but only in the
    /// indices.
    TexelCell(const core::Vec2& uv, int width, int height) {
        const float x = uv.x * float(width) + 0.5f, y = uv.y * float(height) + 0.5f;
        i = int(std::max(0.0f, std::min(x, float(width))));
        j = int(std::max(0.0f, std::min(y, float(height))));
        s = x - float(i--), t = y - float(j--);
    }
    std::array<float, 4> weights() const {
        return {(1.0f - s) * (1.0f - t), s * (1.0f - t), (1.0f - s) * t, s * t};
    }
};

/// The index of the interval of [0, 1] that u lies in.
inline int texel_index(float u, int count) {
    return int(std::max(0.0f, std::min(u * float(count), float(count - 1))));
}

/// Eq. 7.4: log2 of the longer of two differences of texture coordinates, in texels.
inline float mip_level_of(const core::Vec2& dx, const core::Vec2& dy) {
    return 0.5f * std::log2(std::max(glm::dot(dx, dx), glm::dot(dy, dy)));
}

/// All directions on a square of size * size texels.
struct OctahedralMap {
    int size;

    int texels() const { return size * size; }
    core::Vec2 uv(const core::Vec3& d) const { return 0.5f * core::octahedral_project(d) + 0.5f; }

    int texel(const core::Vec3& d) const {
        const core::Vec2 p = uv(d);
        return texel_index(p.y, size) * size + texel_index(p.x, size);
    }
    /// The unit direction of a texel's centre.
    core::Vec3 direction(int texel) const {
        const core::Vec2 centre(float(texel % size) + 0.5f, float(texel / size) + 0.5f);
        return core::octahedral_unproject(2.0f * (centre / float(size)) - 1.0f);
    }
    BilinearFootprint footprint(const core::Vec3& d) const {
        const TexelCell c(uv(d), size, size);
        return {{folded(c.i, c.j), folded(c.i + 1, c.j), folded(c.i, c.j + 1), folded(c.i + 1, c.j + 1)},
                c.weights()};
    }

    /// The texel that lies at column i of row j, both in [-1, size]: beyond an edge the map continues where
    /// the edge is met again, turned by half a circle about the edge's middle.
    int folded(int i, int j) const {
        const int last = size - 1;
        const int row = unsigned(i) > unsigned(last) ? last - j : j;
        const int column = std::clamp(i, 0, last);
        const int x = unsigned(row) > unsigned(last) ? last - column : column;
        return std::clamp(row, 0, last) * size + x;
    }

    /// The mip level for a footprint with the corners d, d_x and d_y. Two directions below the horizon may
    /// lie on two sides of a cut; mirrored into the uncut half they have their true distance (Sec. 7.2.2).
    /// Where one lies above and one below, the mirrored distance would be too small, and nothing is cut
    /// between them.
    float mip_level(const core::Vec3& d, const core::Vec3& d_x, const core::Vec3& d_y) const {
        return mip_level_of(difference(d, d_x), difference(d, d_y));
    }

  private:
    /// In texels.
    core::Vec2 difference(const core::Vec3& a, const core::Vec3& b) const {
        const core::Vec2 plain = uv(b) - uv(a);
        const auto up = [](const core::Vec3& v) { return core::Vec3(v.x, v.y, std::fabs(v.z)); };
        const core::Vec2 mirrored = uv(up(b)) - uv(up(a));
        const bool both_below = a.z < 0.0f && b.z < 0.0f;
        const bool cut = both_below && glm::dot(mirrored, mirrored) < glm::dot(plain, plain);
        return float(size) * (cut ? mirrored : plain);
    }
};

/// The hemisphere z >= 0 on a square of size * size texels, for lights on surfaces. What lies below is looked
/// up mirrored at the horizon. Beyond the horizon there is nothing to interpolate with: the last texel is
/// repeated.
struct HemiOctahedralMap {
    int size;

    int texels() const { return size * size; }
    core::Vec2 uv(const core::Vec3& d) const { return 0.5f * core::hemi_octahedral_project(d) + 0.5f; }

    int texel(const core::Vec3& d) const {
        const core::Vec2 p = uv(d);
        return texel_index(p.y, size) * size + texel_index(p.x, size);
    }
    core::Vec3 direction(int texel) const {
        const core::Vec2 centre(float(texel % size) + 0.5f, float(texel / size) + 0.5f);
        return core::hemi_octahedral_unproject(2.0f * (centre / float(size)) - 1.0f);
    }
    BilinearFootprint footprint(const core::Vec3& d) const {
        const TexelCell c(uv(d), size, size);
        const int left = std::max(c.i, 0), right = std::min(c.i + 1, size - 1);
        const int low = std::max(c.j, 0) * size, high = std::min(c.j + 1, size - 1) * size;
        return {{low + left, low + right, high + left, high + right}, c.weights()};
    }
    /// Eq. 7.4; nothing is cut.
    float mip_level(const core::Vec3& d, const core::Vec3& d_x, const core::Vec3& d_y) const {
        return mip_level_of(float(size) * (uv(d_x) - uv(d)), float(size) * (uv(d_y) - uv(d)));
    }
};

}  // namespace mote::lights
