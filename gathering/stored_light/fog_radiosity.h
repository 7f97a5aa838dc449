// Light exchanged between points on surfaces and points in media, by Jacobi iteration: radiosity with a
// medium between the walls (Rushmeier & Torrance 1987), with micro-buffers for its form factors.
#pragma once

#include "gathering/stored_light/point_radiosity.h"
#include "gathering/volume_points/fog_buffers.h"

namespace mote::gathering {

/// Light that arrives: by place of the surfaces [W/m^2], and by point of the media.
struct FogLight {
    std::vector<core::Rgb> irradiance;
    std::vector<Fluence> fluence;
};

/// Who exchanges light: all are kept by reference.
struct FogExchange {
    const PointHierarchy& surface_hierarchy;
    const SurfelSides& sides;
    const VolumeHierarchy& volume_hierarchy;
    const VolumePoints& points;
    const FogBuffers& hemispheres;  ///< of surfaces: HemisphereMap::cosine
    const FogBuffers& spheres;      ///< of points: equal_area, two for each
};

/// `arriving` and what every place and point gathers of what the others scattered, after as many steps as
/// there are bounces. One place in each node of level `settings.level` gathers for the places around it, one
/// point in each of level `volume_level` for all points of the node. Light that leaves the scene is lost. The
/// same for any number of threads; throws core::Cancelled.
FogLight fog_radiosity(const FogExchange& between, FogLight arriving, std::uint32_t volume_level,
                       const PointRadiositySettings& settings);

/// What arrives at a point from the hemisphere around frame.n. `radiance` is of buffers of `equal_area`.
Fluence gathered_fluence(const HemisphereTexels& texels, const core::Frame& frame,
                         std::span<const core::Rgb> radiance);
/// The two receivers of a point, whose frame is turned by u.
std::array<MicroReceiver, 2> sphere_receivers(const core::Vec3& position, const core::Vec2& u, float turn);

}  // namespace mote::gathering
