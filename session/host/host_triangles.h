// Micro-buffers and ray-bundles over the triangles of another renderer.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::session {

/// Fronts, from which the corners run counter-clockwise, send and receive light; backs hide it.
struct HostTriangles {
    std::span<const core::Vec3> positions;                    ///< [m]
    std::span<const std::array<std::uint32_t, 3>> triangles;  ///< indices into positions
};

struct MicroGatherSettings {
    std::uint32_t points = 65536;  ///< that represent the surfaces
    std::uint32_t side = 16;       ///< texels of a buffer
    std::uint32_t passes = 1;      ///< buffers of a receiver, with rays in other places of their texels
    std::uint64_t seed = 1;        ///< of the points
};

/// Irradiance [W/m^2] of receivers with unit normals, by micro-buffers of points on the triangles.
/// `radiance`: that of each triangle's front [W/(m^2 sr)]. Throws InputError for arguments that cannot be.
std::vector<core::Rgb> micro_irradiance(const HostTriangles& mesh, std::span<const core::Rgb> radiance,
                                        std::span<const core::Vec3> positions,
                                        std::span<const core::Vec3> normals,
                                        const MicroGatherSettings& settings);

/// Two triangles whose fronts see each other along the direction of a bundle.
struct BundleLink {
    std::uint32_t from, to;  ///< along the direction
    double area;             ///< perpendicular to the direction, by the rays that link them [m^2]
};

/// All links of a bundle of parallel rays, `spacing` [m] apart; in the order of the triangles. `offset`: in
/// [0, 1)^2, of the grid of rays in steps of it; uniform, the areas have no bias. Throws InputError for
/// arguments that cannot be.
std::vector<BundleLink> bundle_links(const HostTriangles& mesh, const core::Vec3& direction, float spacing,
                                     const core::Vec2& offset);

}  // namespace mote::session
