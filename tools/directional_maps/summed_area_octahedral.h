// Means of an octahedral map over boxes of any width, at the cost of a few lookups: a summed-area table over
// the whole sphere (Engelhardt 2013, Sec. 7.3.3), for prefiltered lookups of any glossiness.
//
// A box that reaches over an edge of the square continues where the edge is met again, without a stored
// border: its parts are folded back. Around the four vertices on the horizon it covers some directions twice,
// with all their neighbours, so that the mean stays one over a neighbourhood of the direction.
#pragma once

#include <span>
#include <vector>

#include "lights/directional_maps/octahedral_map.h"

namespace mote::tools {

class SummedAreaOctahedral {
  public:
    /// `texels` are map.size^2 values. Throws InputError when they are not.
    SummedAreaOctahedral(lights::OctahedralMap map, std::span<const core::Rgb> texels);

    struct Mean {
        core::Rgb value;
        float solid_angle;  ///< of the box; what is covered twice counts twice
    };
    /// Over the square of 2 * reach texels around the direction d, weighted by solid angle. `reach` in
    /// texels, held to [1e-2, size / 2].
    Mean mean(const core::Vec3& d, float reach) const;

    std::size_t memory_bytes() const { return table_.size() * sizeof(glm::dvec4); }

  private:
    struct Box {
        double x0, y0, x1, y1;  ///< in texels
    };
    glm::dvec4 folded(Box box) const;
    glm::dvec4 inside(const Box& box) const;
    /// The sum over [0, x] * [0, y], linear within a texel.
    glm::dvec4 corner(double x, double y) const;

    lights::OctahedralMap map_;
    std::vector<glm::dvec4> table_;  ///< (size + 1)^2 sums of value * solid angle, and of solid angle
};

}  // namespace mote::tools
