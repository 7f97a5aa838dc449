// Tables of wavelengths as linear RGB.
//
// The matching functions are the analytic fit of Wyman, Sloan and Shirley 2013 ("Simple analytic
// approximations to the CIE XYZ color matching functions"), the multi-lobe one.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

struct SpectralValue {
    double wavelength;  ///< nm
    double value;
};

/// CIE 1931 matching functions at a wavelength in nm.
Vec3d cie_xyz(double wavelength);

/// CIE XYZ to linear sRGB (IEC 61966-2-1).
Vec3d xyz_to_rgb(const Vec3d& c);

/// A reflectance (or coefficient) lit by daylight (D65), so that the constant 1 is white; or, for emission,
/// light itself, so that the constant 1 (illuminant E) has luminance 1 and is slightly red. Linear between
/// the entries, zero outside them. Entries must rise in wavelength. Negative channels are kept.
Rgb spectrum_to_rgb(std::span<const SpectralValue> table, bool emission);

}  // namespace mote::core
