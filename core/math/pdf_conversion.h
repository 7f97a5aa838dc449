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

/// The weight of one of two sampling techniques (Veach 1997, Eq. 9.8; balance heuristic, one sample each).
inline float balance_heuristic(float pdf_this, float pdf_other) {
    const float sum = pdf_this + pdf_other;
    if (!(sum > 0.0f)) return 0.0f;
    if (std::isinf(pdf_this)) return 1.0f;
    return pdf_this / sum;
}

}  // namespace mote::core
