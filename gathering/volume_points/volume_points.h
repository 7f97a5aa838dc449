// Points that stand for the scattering matter of media: each for a volume around it.
#pragma once

#include "gathering/point_hierarchy/point_hierarchy.h"
#include "gathering/volume_points/medium_samples.h"

namespace mote::gathering {

/// All arrays have one entry a point.
struct VolumePoints {
    std::vector<core::Vec3> positions;      ///< [m]
    std::vector<float> volumes;             ///< that each stands for [m^3]
    std::vector<core::Rgb> sigma_s;         ///< there [1/m]
    std::vector<core::MediumState> states;  ///< the media there

    std::size_t size() const { return positions.size(); }
};

/// About `count` of the places (fewer where few scatter), drawn along their curve at even steps of the
/// scattering coefficient: where twice as much is scattered there are twice as many points, for half the
/// volume each. Sums over points of f times volume are unbiased integrals of f over what scatters. Points
/// that are drawn several times are one with so many times the volume.
VolumePoints draw_volume_points(const MediumSamples& samples, std::uint32_t count, std::uint64_t key);

/// The points' hierarchy. Normals mean nothing in it; leaves are balls.
class VolumeHierarchy {
  public:
    explicit VolumeHierarchy(const VolumePoints& points);

    const PointHierarchy& tree() const { return tree_; }
    /// Of leaf i, whose point is order()[i]: the radius of a ball of the point's volume [m], but at most
    /// three times that of the mean volume: a lone point in thin smoke would be spread over the room.
    float radius(std::uint32_t leaf) const { return radii_[leaf]; }

  private:
    PointHierarchy tree_;
    std::vector<float> radii_;
};

}  // namespace mote::gathering
