// The tables of indices, and how a scene file names them.
#include "core/materials/index_of_refraction.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "core/materials/conductor_table.h"

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

class IndexKind final : public ValueKind {
    std::string type(const Row&) const override { return "float"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        auto& index = *static_cast<IndexOfRefraction*>(member);
        const std::string& name = row.parameter.name;
        const auto it = p.values.find(name);
        const auto* word = it == p.values.end() ? nullptr : std::get_if<std::string>(&it->second.value);
        if (!word)
            index = float(read_number(p, row));
        else if (dielectric_index(*word))
            index = word->c_str();
        else
            unknown(p, name, *word, names_of(dielectrics));
    }
    std::string text(const Row&, const void* member) const override {
        const auto& index = *static_cast<const IndexOfRefraction*>(member);
        return index.name().empty() ? short_number(double(float(index))) : index.name();
    }
};

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

const ValueKind& kind_of(Type<IndexOfRefraction>) {
    static const IndexKind kind;
    return kind;
}

const ParameterList<ConductorIndexSettings>& conductor_index_rows() {
    using S = ConductorIndexSettings;
    static const ParameterList<S> list{
        row("material", &S::material,
            "Name of a conductor (Cu, Au, a-C, ...: all of Mitsuba's); none is a mirror."),
        row("eta", &S::eta, between(0, 1e4), "Real part of the index of refraction, instead of material.")
            .when_absent("0"),
        row("k", &S::k, between(0, 1e4), "Imaginary part of the index (absorption).").when_absent("1")};
    return list;
}

ComplexIndex conductor_index_of(const ConductorIndexSettings& settings, const Properties& p) {
    const auto named = conductor_index(settings.material);
    if (!named) unknown(p, "material", settings.material, names_of(conductor_table()));
    if ((settings.eta || settings.k) && settings.material != "none")
        throw InputError("give either 'material' or 'eta' and 'k', not both", p.where_of("material"));
    return {settings.eta.value_or(named->eta), settings.k.value_or(named->k)};
}

}  // namespace mote::core
