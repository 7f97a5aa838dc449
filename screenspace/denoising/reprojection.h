// Where each pixel's point was in the frame before, and which of the four pixels around that position show
// it.
//
// A pixel of the frame before is taken if it shows the same object, a normal alike and a position within a
// few pixels' footprints; what is left of the bilinear weights is brought to 1. The footprint is the distance
// to the nearest neighbour's position, so it depends on distance and slant, and on no unit.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::screenspace {

/// Noise-free features of a frame's pixels, row by row from the top. Empty spans: not known.
struct FrameFeatures {
    int width = 0, height = 0;
    std::span<const core::Vec3> position;  ///< in the world [m]; not finite where nothing was hit
    std::span<const core::Vec3> normal;    ///< unit
    std::span<const std::uint32_t> id;     ///< of the object
    /// From the pixel to where its point was in the frame before [pixels]; not finite: it was not seen.
    /// Empty: nothing moves on the picture; of a camera that moves: camera_motion().
    std::span<const core::Vec2> motion;
    /// Where the point itself was [m]; empty: it stands still in the world.
    std::span<const core::Vec3> previous_position;

    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    /// Throws std::invalid_argument unless every span is empty or has one entry a pixel.
    void check() const;
};

struct RejectionSettings {
    float position = 3.0f;       ///< largest distance of the points [footprints]
    float normal_cosine = 0.9f;  ///< least cosine between the normals: 26 degrees
};

/// At most four pixels of the frame before; the weights add up to 1, or there are none.
struct PixelHistory {
    std::array<std::uint32_t, 4> pixel{};
    std::array<float, 4> weight{};
    bool any() const { return weight[0] + weight[1] + weight[2] + weight[3] > 0.0f; }
};

/// Throws std::invalid_argument when sizes differ.
std::vector<PixelHistory> reproject(const FrameFeatures& now, const FrameFeatures& before,
                                    const RejectionSettings& settings = {});

/// A camera as it maps homogeneous points of the world to (x w, y w, w) in pixels, from the upper left.
struct FrameCamera {
    glm::dmat4x3 world_to_pixels{0.0};
    core::Vec2 project(const core::Vec3& point) const;  ///< not finite behind the camera
};
/// Motion of points that stand still: as both cameras see them, so that a camera that stands still makes none
/// whatever place in its pixel a point has.
std::vector<core::Vec2> camera_motion(std::span<const core::Vec3> position, const FrameCamera& now,
                                      const FrameCamera& before);

}  // namespace mote::screenspace
