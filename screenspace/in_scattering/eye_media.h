// The media along one eye ray, walked once and asked by several lights.
//
// Segments, and the optical depth of grids at every step of the walk; between steps it is linear, as accurate
// as the walk itself. Media with a closed form are asked anew, which costs less than a table.
#pragma once

#include "screenspace/in_scattering/in_scattering.h"

namespace mote::screenspace {

class EyeMedia {
  public:
    /// From ray.t_min, where `state` holds the media, to ray.t_max; grids in steps of `voxels` voxels.
    EyeMedia(const core::RayQueries& scene, const core::Ray& ray, const core::MediumState& state,
             float voxels, core::WalkContext& walk);

    /// The segments up to the distance t.
    void segments_up_to(float t, std::vector<MediumSegment>& segments) const;
    /// Of all media from ray.t_min to t.
    core::Rgb transmittance(float t, core::WalkContext& walk) const;

  private:
    struct Piece {
        MediumSegment segment;
        core::Rgb before{1.0f};           ///< transmittance up to its start
        std::vector<core::Vec3d> depths;  ///< optical depths at the ends of equal parts; empty: closed form
    };
    core::Rgb within(const Piece& piece, float t, core::WalkContext& walk) const;

    core::Ray ray_;
    float voxels_;
    std::vector<Piece> pieces_;
};

}  // namespace mote::screenspace
