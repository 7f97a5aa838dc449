// glTF gives light in photometric units: candela, lux and candela per square metre.
#pragma once

namespace mote::core {

/// Light of 555 nm has 683 lumens a watt, by the definition of the candela. Exporters take that for light of
/// any colour (Blender's PBR_WATTS_TO_LUMENS), and so do we: W/sr = cd / 683, W/m^2 = lx / 683, and W/(m^2
/// sr) = (cd/m^2) / 683.
inline constexpr double lumens_per_watt = 683.0;

}  // namespace mote::core
