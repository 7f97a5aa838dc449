// <spectrum>: tables of wavelengths as linear RGB.
//
// The matching functions are the analytic fit of Wyman, Sloan and Shirley 2013 ("Simple analytic
// approximations to the CIE XYZ color matching functions"), the multi-lobe one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "core/objects/error.h"

namespace mote::core {

struct SpectralValue {
    double wavelength;  ///< nm
    double value;
};

/// CIE 1931 matching functions at a wavelength in nm.
Vec3d cie_xyz(double wavelength);

/// A reflectance (or coefficient) lit by daylight (D65), so that the constant 1 is white; or, for emission,
/// light itself, so that the constant 1 (illuminant E) has luminance 1 and is slightly red. Linear between
/// the entries, zero outside them. Entries must rise in wavelength. Negative channels are kept.
Rgb spectrum_to_rgb(std::span<const SpectralValue> table, bool emission);

/// "0.5" is grey; "400:0.1, 500:0.2, ..." is a table. Throws InputError for anything else. Colours outside
/// sRGB are clamped, with a warning.
Rgb parse_spectrum(const std::string& text, bool emission, const SourceLocation& where,
                   std::vector<std::string>& warnings);

}  // namespace mote::core
