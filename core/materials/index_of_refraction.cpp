// The tables of indices, and how a scene file names them.
#include "core/materials/index_of_refraction.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "core/materials/conductor_table.h"
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
    const auto known = [&](const NamedConductor& entry) {
        const std::string_view stem = entry.name;
        return name == stem ||
               (entry.palik && name.starts_with(stem) && name.substr(stem.size()) == "_palik");
    };
    const auto table = conductor_table();
    const auto found = std::find_if(table.begin(), table.end(), known);
    if (found == table.end()) return std::nullopt;
    const auto rgb = [](const float(&c)[3]) { return Rgb(c[0], c[1], c[2]); };
    return ComplexIndex{rgb(found->eta), rgb(found->k)};
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
    if (!named) unknown(p, "material", material, names_of(conductor_table()));
    const bool explicit_index = p.has("eta") || p.has("k");
    if (explicit_index && material != "none")
        throw InputError("give either 'material' or 'eta' and 'k', not both", p.where_of("material"));
    return {p.get_rgb_in("eta", named->eta, 0.0f, 1e4f), p.get_rgb_in("k", named->k, 0.0f, 1e4f)};
}

}  // namespace mote::core
