// Selects candidates that keep a distance from each other: Poisson-disc points on surfaces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "core/objects/cancellation.h"

namespace mote::gathering {

struct DartThrow {
    std::vector<std::uint32_t> chosen;  ///< candidates, in the order in which they were chosen
    float distance = 0.0f;              ///< that all chosen ones keep, at least [m]
    float covering_radius = 0.0f;       ///< hardly any place is farther from a chosen point [m]
};

/// Chooses `count` of the candidates, which are uniform over `area` [m^2], at least as many, and should
/// follow each other along some curve. Candidates in random order become points where no point is nearer than
/// a distance; it begins as the largest that so many points of a plane could keep, and shrinks whenever all
/// candidates were tried. Only points whose normals are less than 90 degrees apart keep it: walls have two
/// sides.
DartThrow throw_darts(std::span<const core::Vec3> positions, std::span<const core::Vec3> normals,
                      std::size_t count, double area, std::uint64_t seed, core::CancelToken cancelled = {});

}  // namespace mote::gathering
