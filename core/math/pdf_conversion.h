// Conversions between the measures of densities, in one place: solid angle <-> area.
#pragma once

#include "core/math/vec.h"

namespace mote::core {

/// Density per solid angle at a reference point of a density per area at distance d with cosine |cos| at the
/// area.
inline float area_to_solid_angle(float pdf_area, float distance_squared, float cosine) {
    const float c = std::fabs(cosine);
    return c > 0.0f ? pdf_area * distance_squared / c : 0.0f;
}
inline float solid_angle_to_area(float pdf_solid_angle, float distance_squared, float cosine) {
    return pdf_solid_angle * std::fabs(cosine) / distance_squared;
}

}  // namespace mote::core
