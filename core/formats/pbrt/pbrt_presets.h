// Named scattering media.
#pragma once

#include <string>

#include "core/math/vec.h"
#include "core/objects/error.h"

namespace mote::core {

struct PbrtPreset {
    const char* name;
    Rgb sigma_s, sigma_a;  ///< reduced scattering and absorption [1/mm]
};

/// Throws InputError with the nearest name.
const PbrtPreset& pbrt_preset(const std::string& name, const SourceLocation& where);

}  // namespace mote::core
