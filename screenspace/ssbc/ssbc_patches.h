// The patch of surface behind each pixel, as a parallelogram.
//
// A patch reaches half a pixel to every side, except where the neighbour shows another surface that meets
// this one in a concave edge, such as a floor and a wall: there it reaches just to the edge. All that near
// light hangs on this. What touches the edge fills half of the view of a receiver beside it, and patches that
// reach past the edge, or end before it, would send too much or nothing at all, in turns along the edge.
//
// Among the sides of several layers (ssbc_layers.h) a surface continues wherever a neighbour has it, and an
// edge may be one with any side there, or with another side here: the floor behind a block ends at its back.
#pragma once

#include <vector>

#include "screenspace/ssbc/ssbc_layers.h"

namespace mote::screenspace {

struct PixelPatch {
    core::Vec3 centre{0.0f};
    core::Vec3 a{0.0f}, b{0.0f};  ///< halves of the sides: the patch is centre + [-1, 1] a + [-1, 1] b
    core::Vec3 normal{0.0f};
    float area = 0.0f;  ///< [m^2]; 0: takes no part
};

/// One patch a pixel. Two pixels show one surface up to `angle` [rad] between their normals, and between the
/// line that joins them and their planes.
std::vector<PixelPatch> pixel_patches(const SsbcSurfaces& surfaces, float angle);

/// Patches of pictures below each other: `surfaces` has the height of all.
std::vector<PixelPatch> pixel_patches(const SsbcSurfaces& surfaces, const SideLayout& layout, float angle);

}  // namespace mote::screenspace
