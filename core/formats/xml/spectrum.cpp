// Reads the text of <spectrum>.
#include "core/formats/xml/spectrum.h"

#include <algorithm>

#include "core/formats/spectra/spectral_table.h"
#include "core/formats/xml/scene_values.h"

namespace mote::core {
namespace {

std::vector<SpectralValue> parse_table(const std::string& text, const SourceLocation& where) {
    std::vector<SpectralValue> table;
    for (const std::string& entry : split_words(text)) {
        const std::size_t colon = entry.find(':');
        if (colon == std::string::npos)
            throw InputError("'" + printable(entry, 40) + "' is not of the form wavelength:value", where);
        const SpectralValue v{parse_number(entry.substr(0, colon), where),
                              parse_number(entry.substr(colon + 1), where)};
        if (!table.empty() && !(v.wavelength > table.back().wavelength))
            throw InputError("the wavelengths of a spectrum must rise", where);
        table.push_back(v);
    }
    return table;
}

}  // namespace

Rgb parse_spectrum(const std::string& text, bool emission, const SourceLocation& where,
                   std::vector<std::string>& warnings) {
    if (text.find(':') == std::string::npos) {
        const double value = parse_number(text, where);
        if (emission)
            warnings.push_back(
                InputError("a uniform <spectrum> on a light is taken as grey; Mitsuba tints it", where)
                    .what());
        return Rgb(float(value));
    }
    const std::vector<SpectralValue> table = parse_table(text, where);
    const Rgb exact = spectrum_to_rgb(table, emission);
    // A reflectance stays one: a saturated colour may leave sRGB by a little.
    const bool bounded = std::all_of(table.begin(), table.end(),
                                     [](const SpectralValue& v) { return v.value >= 0.0 && v.value <= 1.0; });
    const bool positive =
        std::all_of(table.begin(), table.end(), [](const SpectralValue& v) { return v.value >= 0.0; });
    Rgb result = exact;
    if (positive) result = glm::max(result, Rgb(0.0f));
    if (bounded && !emission) result = glm::min(result, Rgb(1.0f));
    if (glm::length(result - exact) > 1e-3f * glm::length(exact))
        warnings.push_back(InputError("a spectrum lies outside of sRGB and was clamped", where).what());
    return result;
}

}  // namespace mote::core
