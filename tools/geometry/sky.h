// A clear sky as a latitude-longitude picture: not measured, only bright at the horizon and around the sun.
#pragma once

#include <filesystem>

#include "core/math/vec.h"

namespace mote::tools {

struct Sky {
    float elevation = 18.0f, azimuth = 60.0f;  ///< of the sun, degrees; azimuth from -z towards +x
    int height = 256;                          ///< rows; twice as many columns
};

/// Radiance from a direction (unit length, y up) [W/(m^2 sr)]. The disc of the sun is left out: a directional
/// light represents it. Below the horizon lies a dull, hazy ground.
core::Rgb sky_radiance(const Sky& sky, const core::Vec3& direction);
/// In the layout of the `envmap` light. Throws core::InputError when the file cannot be written.
void write_sky(const std::filesystem::path& path, const Sky& sky);

}  // namespace mote::tools
