// Emission of a medium: a constant or varying radiance, or a black body by temperature (as in pbrt-v4).
#pragma once

#include <memory>

#include "core/math/vec.h"
#include "media/volume.h"

namespace mote::media {

class BlackbodyTable;

/// The L_e [W/(m^2 sr)] that sigma_a multiplies in the source term.
struct Emission {
    float scale = 1.0f;     ///< Lescale
    VolumePtr radiance;     ///< Le; or
    VolumePtr temperature;  ///< (temperature - offset) * temperature_scale is in kelvin
    float temperature_scale = 1.0f, temperature_offset = 0.0f;
    std::shared_ptr<const BlackbodyTable> blackbody;  ///< goes with temperature

    bool any() const { return scale > 0.0f && (radiance || temperature); }
    core::Rgb at(const core::Vec3& p) const;
};

/// Le, Lescale, temperature, temperature_scale and temperature_offset.
const core::ParameterList<Emission>& emission_rows();
/// Completes what was read. Throws InputError where both Le and temperature are given.
void finish_emission(Emission& emission, const core::Properties& properties);

}  // namespace mote::media
