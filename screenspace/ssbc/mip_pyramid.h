// Mip pyramids over what a picture shows: patches of surface, and the light that they send (Engelhardt 2013,
// Sec. 11.2.2).
//
// Level 0 is the picture; a node of the next level represents up to 2 x 2 nodes. Means are weighted by area
// and areas are added up, so that a node sends the power of its pixels; a plain mean over a border of the
// picture, or over a patch seen at a slant beside one seen from the front, would not. Pixels without surface
// have no area and drop out of everything. A pyramid of reflectance is not needed: light is stored as it is
// reflected.
//
// The discontinuity pyramid marks nodes whose means represent no real surface: where two children face
// different ways, or one does not continue the plane of the other, or a child is marked (after Nichols &
// Wyman 2009). Besides means, nodes keep bounds, which enclose for certain what lies near: the mean of a
// pixel of the foreground and one of the background is far from both.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/bounds.h"
#include "screenspace/ssbc/ssbc_patches.h"

namespace mote::screenspace {

struct SurfaceNode {
    core::Vec3 position{0.0f};  ///< [m]
    float area = 0.0f;          ///< [m^2]; 0: there is nothing here
    core::Vec3 normal{0.0f};    ///< mean, not of unit length where the node is curved
    core::Bounds3 bounds;       ///< of the patches of all pixels [m]
    float radius = 0.0f;        ///< they lie this near to `position` [m]
    float thickness = 0.0f;     ///< and this near to the plane through it [m]
    float spread = 0.0f;        ///< of normals: about the sine of their angle with the mean
};

/// A parallelogram as a node.
SurfaceNode patch_node(const PixelPatch& patch);

struct PyramidLevel {
    int width = 0, height = 0;
    std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width) + std::size_t(x); }
    std::size_t size() const { return std::size_t(width) * std::size_t(height); }
};

class SurfacePyramid {
  public:
    struct Level : PyramidLevel {
        std::vector<SurfaceNode> nodes;
        std::vector<std::uint8_t> discontinuity;  ///< 1: the node's means represent no real surface
    };

    /// One patch a pixel. Two nodes are taken for one surface up to `angle` [rad] between their normals, and
    /// between the line that joins them and their planes.
    SurfacePyramid(int width, int height, std::vector<PixelPatch> patches, float angle);

    /// From the picture up to a single node.
    const std::vector<Level>& levels() const { return levels_; }
    /// The patches of the pixels: more of the nodes of level 0.
    const std::vector<PixelPatch>& patches() const { return patches_; }

  private:
    std::vector<Level> levels_;
    std::vector<PixelPatch> patches_;
};

/// Power per unit projected solid angle that nodes send: the sum of area times radiance [W/sr].
class LightPyramid {
  public:
    /// Storage for the pyramid of the same picture.
    explicit LightPyramid(const SurfacePyramid& surfaces);
    /// Puts light into the pyramid: the radiance that each pixel reflects, the same to all sides.
    void fill(const SurfacePyramid& surfaces, std::span<const core::Rgb> radiance);

    const core::Rgb& power(int level, std::size_t node) const { return levels_[std::size_t(level)][node]; }

  private:
    std::vector<std::vector<core::Rgb>> levels_;
};

}  // namespace mote::screenspace
