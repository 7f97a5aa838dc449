// Emission of a medium: a constant or varying radiance, or a black body by temperature (as in pbrt-v4).
#pragma once

#include <memory>

#include "core/math/vec.h"

namespace mote::core {
class Properties;
struct Parameter;
}  // namespace mote::core

namespace mote::media {

class Volume;
class BlackbodyTable;

/// The L_e [W/(m^2 sr)] that sigma_a multiplies in the source term.
struct Emission {
    float scale = 1.0f;                         ///< Lescale
    std::shared_ptr<const Volume> radiance;     ///< Le; or
    std::shared_ptr<const Volume> temperature;  ///< (temperature - offset) * temperature_scale is in kelvin
    float temperature_scale = 1.0f, temperature_offset = 0.0f;
    std::shared_ptr<const BlackbodyTable> blackbody;  ///< goes with temperature

    bool any() const { return scale > 0.0f && (radiance || temperature); }
    core::Rgb at(const core::Vec3& p) const;
};

/// Reads Le, Lescale, temperature, temperature_scale and temperature_offset.
Emission emission_of(const core::Properties& properties);

}  // namespace mote::media
