// Where the rays of a shadow map start, and where on the map a point lies: one map of rays for every kind of
// light.
//
//   octahedral     point lights and virtual point lights in media: all directions (Engelhardt 2013, Ch. 7)
//   hemispherical  virtual point lights on surfaces: the octahedron's upper half over the whole square
//   perspective    spot lights: a square around the cone
//   parallel       directional lights: parallel rays from a square before the scene
#pragma once

#include "core/math/frame.h"
#include "core/math/ray.h"
#include "lights/directional_maps/octahedral_map.h"

namespace mote::lights {

/// The rays of a map and their inverse.
struct ShadowMapView {
    /// See the top of this file.
    enum class Kind : std::uint8_t { octahedral, hemispherical, perspective, parallel };

    Kind kind = Kind::octahedral;  ///< how positions and rays belong together
    core::Vec3 origin{0.0f};       ///< of the light; parallel: centre of the square that rays start from
    core::Frame frame;             ///< n: up of the map, axis of a spot or of parallel light
    float half_extent =
        1.0f;       ///< perspective: tangent of half the angle; parallel: half the square's edge [m]
    int size = 64;  ///< texels along an edge

    /// View in all directions; `size` texels along an edge.
    static ShadowMapView of_point(const core::Vec3& position, int size);
    /// `normal` on the lit side.
    static ShadowMapView of_surface(const core::Vec3& position, const core::Vec3& normal, int size);
    /// View of a cone around `axis` (unit), [radians] from it.
    static ShadowMapView of_spot(const core::Vec3& position, const core::Vec3& axis, float cutoff_radians,
                                 int size);
    /// Light that travels along `direction` over everything within `radius` of `center`.
    static ShadowMapView of_parallel(const core::Vec3& direction, const core::Vec3& center, float radius,
                                     int size);

    int texels() const { return size * size; }  ///< size^2
    /// The ray through a texel's centre; `t` is the distance from the light, or from the plane of a parallel
    /// one.
    core::Ray ray(int texel) const;
    /// The ray through any position of the map, in [0, 1]^2.
    core::Ray ray_at(const core::Vec2& position) const;
    /// Measure of a piece of the map, per its fraction of the map: solid angle [sr], of a parallel one area
    /// [m^2].
    float measure(const core::Vec2& position) const;
    /// The texel that column i of row j, both in [-1, size], continues the map with: round the edges of the
    /// octahedron, else the nearest.
    int neighbour(int i, int j) const;
    /// Between neighbouring rays at a distance from the light, about [m].
    float spacing(float distance) const;
};

}  // namespace mote::lights
