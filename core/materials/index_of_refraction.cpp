// The tables of indices, and how a scene file names them.
#include "core/materials/index_of_refraction.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "core/objects/properties.h"

namespace mote::core {
namespace {

struct NamedIndex {
    const char* name;
    float value;
};

constexpr NamedIndex dielectrics[] = {
    {"vacuum", 1.0f},      {"helium", 1.000036f},        {"hydrogen", 1.000132f},
    {"air", 1.000277f},    {"carbon dioxide", 1.00045f}, {"water", 1.333f},
    {"acetone", 1.36f},    {"ethanol", 1.361f},          {"carbon tetrachloride", 1.461f},
    {"glycerol", 1.4729f}, {"benzene", 1.501f},          {"silicone oil", 1.52045f},
    {"bromine", 1.661f},   {"water ice", 1.31f},         {"fused quartz", 1.458f},
    {"pyrex", 1.47f},      {"acrylic glass", 1.49f},     {"polypropylene", 1.49f},
    {"bk7", 1.5046f},      {"sodium chloride", 1.544f},  {"amber", 1.55f},
    {"pet", 1.575f},       {"diamond", 2.419f},
};

struct NamedConductor {
    const char* name;
    ComplexIndex index;
};

// Measured spectra (mostly Palik, Handbook of Optical Constants) averaged to linear sRGB: the values
// published with the Tungsten renderer, rounded. Mitsuba's come from the same spectra.
const NamedConductor conductors[] = {
    {"none", {{0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}}},
    {"Ag", {{0.15526f, 0.11672f, 0.13838f}, {4.82834f, 3.12225f, 2.14695f}}},
    {"Al", {{1.65746f, 0.88037f, 0.52123f}, {9.22387f, 6.26952f, 4.83700f}}},
    {"Au", {{0.14312f, 0.37496f, 1.44248f}, {3.98316f, 2.38572f, 1.60322f}}},
    {"Be", {{4.18506f, 3.18506f, 2.78409f}, {3.83544f, 3.01013f, 2.86901f}}},
    {"Cr", {{4.36968f, 2.91670f, 1.65470f}, {5.20643f, 4.23136f, 3.75495f}}},
    {"Cu", {{0.20044f, 0.92403f, 1.10221f}, {3.91295f, 2.45285f, 2.14219f}}},
    {"Hg", {{2.39893f, 1.44003f, 0.90955f}, {6.32763f, 4.37194f, 3.42179f}}},
    {"Ir", {{3.08641f, 2.08219f, 1.61789f}, {5.59215f, 4.06718f, 3.26726f}}},
    {"K", {{0.06405f, 0.04641f, 0.03818f}, {2.10422f, 1.34894f, 0.91321f}}},
    {"Li", {{0.26579f, 0.19561f, 0.22092f}, {3.54017f, 2.31113f, 1.66859f}}},
    {"Mo", {{4.48370f, 3.52546f, 2.77608f}, {4.11113f, 3.42087f, 3.15060f}}},
    {"Nb", {{3.42014f, 2.79019f, 2.39559f}, {3.44138f, 2.73764f, 2.57991f}}},
    {"Rh", {{2.58580f, 1.86019f, 1.55443f}, {6.78229f, 4.70295f, 3.97609f}}},
    {"Ta", {{2.06258f, 2.39309f, 2.62807f}, {2.40805f, 1.74137f, 1.94704f}}},
    {"TiN", {{1.64847f, 1.15045f, 1.37978f}, {3.36846f, 1.94349f, 1.10201f}}},
    {"VN", {{2.86560f, 2.11918f, 1.94008f}, {3.03233f, 2.05611f, 1.61629f}}},
    {"W", {{4.37070f, 3.30030f, 2.99827f}, {3.50068f, 2.60487f, 2.27319f}}},
};

template <typename Table>
std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names;
    for (const auto& entry : table) names.emplace_back(entry.name);
    return names;
}

[[noreturn]] void unknown(const Properties& p, const std::string& parameter, const std::string& word,
                          const std::vector<std::string>& known) {
    throw InputError(
        "'" + parameter + "' names the unknown material '" + printable(word) + "'" + suggestion(word, known),
        p.where_of(parameter));
}

}  // namespace

std::optional<float> dielectric_index(std::string_view name) {
    std::string lower(name);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    for (const NamedIndex& entry : dielectrics)
        if (lower == entry.name) return entry.value;
    return std::nullopt;
}

std::optional<ComplexIndex> conductor_index(std::string_view name) {
    for (const NamedConductor& entry : conductors)
        if (name == entry.name) return entry.index;
    return std::nullopt;
}

float dielectric_index_parameter(const Properties& p, const std::string& name,
                                 const std::string& default_name) {
    const auto it = p.values.find(name);
    if (it != p.values.end() && !std::holds_alternative<std::string>(it->second.value))
        return float(p.get_float_in(name, 1.0, 0.01, 100.0));
    const std::string word = p.get_string(name, default_name);
    const auto index = dielectric_index(word);
    if (!index) unknown(p, name, word, names_of(dielectrics));
    return *index;
}

ComplexIndex conductor_parameters(const Properties& p) {
    const std::string material = p.get_string("material", "none");
    const auto named = conductor_index(material);
    if (!named) unknown(p, "material", material, names_of(conductors));
    const bool explicit_index = p.has("eta") || p.has("k");
    if (explicit_index && material != "none")
        throw InputError("give either 'material' or 'eta' and 'k', not both", p.where_of("material"));
    return {p.get_rgb_in("eta", named->eta, 0.0f, 1e4f), p.get_rgb_in("k", named->k, 0.0f, 1e4f)};
}

}  // namespace mote::core
