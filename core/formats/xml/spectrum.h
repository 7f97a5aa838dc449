// <spectrum>: a number or a table of wavelengths as linear RGB.
#pragma once

#include <string>
#include <vector>

#include "core/math/vec.h"
#include "core/objects/error.h"

namespace mote::core {

/// "0.5" is grey; "400:0.1, 500:0.2, ..." is a table. Throws InputError for anything else. Colours outside
/// sRGB are clamped, with a warning.
Rgb parse_spectrum(const std::string& text, bool emission, const SourceLocation& where,
                   std::vector<std::string>& warnings);

}  // namespace mote::core
