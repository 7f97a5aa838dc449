// Conversion of spectra by kind.
#include "core/formats/pbrt/pbrt_spectra.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/formats/spectra/spectral_table.h"
#include "core/materials/conductor_table.h"
#include "core/objects/number_text.h"

namespace mote::core {
namespace {

/// Linear RGB of another space to linear sRGB, by rows (primaries and white points of ITU-R BT.2020, SMPTE
/// RP 431-2 with white D65, and ACES AP0 adapted to D65).
struct ColorSpace {
    const char* name;
    double rows[3][3];
};
constexpr ColorSpace color_spaces[] = {
    {"srgb", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {"rec2020",
     {{1.660491, -0.587641, -0.072850}, {-0.124550, 1.132900, -0.008349}, {-0.018151, -0.100579, 1.118730}}},
    {"dci-p3", {{1.224940, -0.224940, 0.0}, {-0.042057, 1.042057, 0.0}, {-0.019638, -0.078636, 1.098274}}},
    {"aces2065-1",
     {{2.521686, -1.134131, -0.387555}, {-0.276480, 1.372719, -0.096239}, {-0.015378, -0.152975, 1.168353}}}};

/// Chromaticities of CIE standard illuminants (CIE 15:2004, 2 degrees) and ACES.
struct Illuminant {
    const char* name;
    double x, y;
};
constexpr Illuminant illuminants[] = {{"stdillum-A", 0.44757, 0.40745},   {"stdillum-D50", 0.34567, 0.35850},
                                      {"stdillum-D65", 0.31272, 0.32903}, {"illum-acesD60", 0.32168, 0.33767},
                                      {"stdillum-F1", 0.3131, 0.3371},    {"stdillum-F2", 0.3721, 0.3751},
                                      {"stdillum-F3", 0.4091, 0.3941},    {"stdillum-F4", 0.4402, 0.4031},
                                      {"stdillum-F5", 0.3138, 0.3452},    {"stdillum-F6", 0.3779, 0.3882},
                                      {"stdillum-F7", 0.3129, 0.3292},    {"stdillum-F8", 0.3458, 0.3586},
                                      {"stdillum-F9", 0.3741, 0.3727},    {"stdillum-F10", 0.3458, 0.3588},
                                      {"stdillum-F11", 0.3805, 0.3769},   {"stdillum-F12", 0.4370, 0.4042}};

/// Index of refraction at 587.6 nm (Schott's data sheets; pbrt's F5, F10 and F11 are the glasses SF5, ...).
struct Glass {
    const char* name;
    double eta;
};
constexpr Glass glasses[] = {{"glass-BK7", 1.5168},   {"glass-BAF10", 1.6700}, {"glass-FK51A", 1.4866},
                             {"glass-LASF9", 1.8503}, {"glass-F5", 1.6727},    {"glass-F10", 1.7283},
                             {"glass-F11", 1.7847}};

/// Brass (70 % copper), the one conductor of pbrt's that conductor_table() lacks.
constexpr NamedConductor brass = {"CuZn", false, {0.444f, 0.527f, 1.094f}, {3.695f, 2.765f, 1.829f}};

Rgb in_srgb(const double* n, const std::string& space) {
    const auto it = std::find_if(std::begin(color_spaces), std::end(color_spaces),
                                 [&](const ColorSpace& c) { return c.name == space; });
    Rgb out;
    for (int i = 0; i < 3; ++i)
        out[i] = float(it->rows[i][0] * n[0] + it->rows[i][1] * n[1] + it->rows[i][2] * n[2]);
    return glm::max(out, 0.0f);
}

Rgb of_luminance_one(const Rgb& c) {
    const float y = luminance(c);
    return y > 0.0f ? glm::max(c / y, 0.0f) : Rgb(0.0f);
}

std::vector<SpectralValue> table_of(const std::vector<double>& numbers, const SourceLocation& where) {
    if (numbers.empty() || numbers.size() % 2 != 0)
        throw InputError("a spectrum is pairs of wavelength and value", where);
    std::vector<SpectralValue> table;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        if (!table.empty() && !(numbers[i] > table.back().wavelength))
            throw InputError("the wavelengths of a spectrum must rise", where);
        table.push_back({numbers[i], numbers[i + 1]});
    }
    return table;
}

/// A file of pairs, with comments after #.
std::vector<SpectralValue> table_of_file(const std::string& name, const SourceLocation& where,
                                         PbrtFiles& files) {
    PbrtText text(read_pbrt_file(files.find(name, where)), name);
    std::vector<double> numbers;
    while (const auto token = text.next())
        numbers.push_back(pbrt_number(token->text, text.where(token->line)));
    return table_of(numbers, where);
}

/// "metal-Cu-eta" and "metal-Cu-k".
std::optional<Rgb> metal(const std::string& name) {
    const auto find_in = [&](const NamedConductor& c) -> const float* {
        const std::string stem = std::string("metal-") + c.name;
        return name == stem + "-eta" ? c.eta : name == stem + "-k" ? c.k : nullptr;
    };
    const float* v = find_in(brass);
    for (const NamedConductor& c : conductor_table())
        if (!v) v = find_in(c);
    return v ? std::optional(Rgb(v[0], v[1], v[2])) : std::nullopt;
}

[[noreturn]] void refuse_name(const std::string& name, const SourceLocation& where) {
    std::vector<std::string> known;
    for (const Illuminant& i : illuminants) known.push_back(i.name);
    for (const Glass& g : glasses) known.push_back(g.name);
    for (const char* metal : {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"})
        for (const char* part : {"-eta", "-k"}) known.push_back(std::string("metal-") + metal + part);
    throw InputError("there is no spectrum '" + printable(name, 60) + "', and no file of that name" +
                         suggestion(name, known),
                     where);
}

Rgb named_light(const std::string& name, const SourceLocation& where, PbrtFiles& files) {
    for (const Illuminant& i : illuminants)
        if (name == i.name)
            return of_luminance_one(Rgb(xyz_to_rgb({i.x / i.y, 1.0, (1.0 - i.x - i.y) / i.y})));
    if (name.find('.') == std::string::npos) refuse_name(name, where);
    return of_luminance_one(spectrum_to_rgb(table_of_file(name, where, files), true));
}

Rgb named_coefficient(const std::string& name, const SourceLocation& where, PbrtFiles& files) {
    if (const auto known = metal(name)) return *known;
    for (const Glass& g : glasses)
        if (name == g.name) return Rgb(float(g.eta));
    if (name.find('.') == std::string::npos) refuse_name(name, where);
    return spectrum_to_rgb(table_of_file(name, where, files), false);
}

void require_rgb(const PbrtParameter& p) {
    if (p.numbers.size() != 3)
        throw InputError("'" + printable(p.name, 40) + "' needs three numbers", p.where);
    if (*std::min_element(p.numbers.begin(), p.numbers.end()) < 0.0)
        throw InputError("'" + printable(p.name, 40) + "' has a negative component", p.where);
}

}  // namespace

const std::vector<std::string>& pbrt_color_spaces() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const ColorSpace& c : color_spaces) list.push_back(c.name);
        return list;
    }();
    return names;
}

Rgb pbrt_blackbody(double kelvin) {
    Vec3d xyz(0.0);
    for (double w = 360.0; w <= 830.0; w += 1.0) {
        const double x = 1.438776877e7 / (w * kelvin);  // hc / (lambda k T), Planck's law
        if (x < 700.0) xyz += cie_xyz(w) / (std::pow(w / 560.0, 5.0) * std::expm1(x));
    }
    return xyz.y > 0.0 ? of_luminance_one(Rgb(xyz_to_rgb(xyz / xyz.y))) : Rgb(0.0f);
}

Rgb pbrt_light_color(const PbrtObject& object, const std::string& name, PbrtFiles& files) {
    const PbrtParameter* p = object.find(name);
    if (!p) return Rgb(1.0f);
    if (p->type == "rgb" || p->type == "color") {
        require_rgb(*p);
        return in_srgb(p->numbers.data(), p->color_space);
    }
    if (p->type == "blackbody") {
        const double kelvin = object.number(name, 0.0);
        if (!(kelvin > 0.0)) throw InputError("a black body needs a temperature above 0 K", p->where);
        return pbrt_blackbody(kelvin);
    }
    if (p->type != "spectrum")
        throw InputError("'" + printable(name, 40) + "' is a " + p->type + ", not the colour of a light",
                         p->where);
    if (!p->strings.empty()) return named_light(p->strings[0], p->where, files);
    return of_luminance_one(spectrum_to_rgb(table_of(p->numbers, p->where), true));
}

Rgb pbrt_color_of(const PbrtParameter& p, PbrtFiles& files, bool reflectance) {
    Rgb color(0.0f);
    if (p.type == "rgb" || p.type == "color") {
        require_rgb(p);
        color = in_srgb(p.numbers.data(), p.color_space);
    } else if (p.type == "spectrum" && !p.strings.empty()) {
        color = named_coefficient(p.strings[0], p.where, files);
    } else if (p.type == "spectrum") {
        color = spectrum_to_rgb(table_of(p.numbers, p.where), false);
    } else if (p.type == "float" && p.numbers.size() == 1) {
        color = Rgb(float(p.numbers[0]));
    } else {
        throw InputError("'" + printable(p.name, 40) + "' of type " + p.type + " is no colour", p.where);
    }
    color = glm::max(color, 0.0f);
    return reflectance ? glm::min(color, 1.0f) : color;
}

std::optional<Rgb> pbrt_color(const PbrtObject& object, const std::string& name, PbrtFiles& files,
                              bool reflectance) {
    const PbrtParameter* p = object.find(name);
    if (!p || p->type == "texture") return std::nullopt;
    return pbrt_color_of(*p, files, reflectance);
}

double pbrt_index_of_refraction(const PbrtObject& object, const std::string& name, double default_value,
                                PbrtFiles& files) {
    const auto color = pbrt_color(object, name, files, false);
    if (!color) return default_value;
    if (min_component(*color) != max_component(*color) || object.find(name)->type == "spectrum")
        files.note("an index of refraction that depends on the wavelength is one number here: no dispersion");
    return double(color->y) > 0.0 ? double(color->y) : 1.0;  // 0 counts as 1, as in pbrt
}

}  // namespace mote::core
