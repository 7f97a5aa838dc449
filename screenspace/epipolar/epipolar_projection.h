// Where a point of the world falls on the film, in homogeneous coordinates.
//
// Eye rays of one lens position are linear in the film position: they share their origin (pinhole, one point
// of a lens), or their direction (parallel projection). Either way the inverse is a projective map, found
// here from three rays, so that every camera that is linear can be projected to and not only those that have
// it.
#pragma once

#include "core/scene/camera.h"

namespace mote::screenspace {

/// The point (x/w, y/w) of the film, in pixels. In front of the camera w > 0, behind it w < 0; w = 0 is a
/// direction on the film. All three are zero for a point that no direction of the film leads to: the eye
/// itself.
struct FilmPoint {
    double x = 0.0, y = 0.0, w = 0.0;  ///< homogeneous
};

/// The inverse of a camera's rays.
class FilmProjection {
  public:
    /// Film of width * height pixels, seen through the point `u_lens` of the lens.
    FilmProjection(const core::Camera& camera, int width, int height, const core::Vec2& u_lens);
    /// `nearest` [m]: a point closer to the eye than this counts as the eye itself.
    FilmPoint project(const core::Vec3d& point, double nearest) const;

  private:
    core::Transform to_camera_;
    core::Vec3d origin_{0.0};
    glm::dmat3 film_from_camera_{1.0};
    bool parallel_ = false;
};

}  // namespace mote::screenspace
