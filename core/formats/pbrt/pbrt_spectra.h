// Spectra of pbrt scenes as linear sRGB: rgb in four colour spaces, black bodies, tables, and names.
//
// Tables and black bodies go through the CIE matching functions (spectral_table.h), named illuminants have
// their CIE chromaticities. Light that is no rgb has luminance 1, as pbrt normalizes it: scale, power and
// illuminance say how bright it is.
#pragma once

#include <optional>

#include "core/formats/pbrt/pbrt_files.h"
#include "core/formats/pbrt/pbrt_parameters.h"

namespace mote::core {

/// Names that the directive ColorSpace takes.
const std::vector<std::string>& pbrt_color_spaces();

/// Radiance of a black body in linear sRGB, scaled to luminance 1; channels outside of sRGB are 0.
Rgb pbrt_blackbody(double kelvin);

/// Light: the parameter's colour, or white where it is not given. Throws InputError for names that are not
/// known.
Rgb pbrt_light_color(const PbrtObject& object, const std::string& name, PbrtFiles& files);

/// A reflectance (0 to 1, clamped as in pbrt where it is a spectrum) or a coefficient such as an index of
/// refraction; nothing where it is not given, or is a texture.
std::optional<Rgb> pbrt_color(const PbrtObject& object, const std::string& name, PbrtFiles& files,
                              bool reflectance);
/// The colour of one parameter.
Rgb pbrt_color_of(const PbrtParameter& parameter, PbrtFiles& files, bool reflectance);

/// An index of refraction: a number, a spectrum, or a glass by name.
double pbrt_index_of_refraction(const PbrtObject& object, const std::string& name, double default_value,
                                PbrtFiles& files);

}  // namespace mote::core
