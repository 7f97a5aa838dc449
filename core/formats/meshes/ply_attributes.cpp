// Groups the properties by what stands before their last underscore.
#include "core/formats/meshes/ply_attributes.h"

#include <map>
#include <optional>

namespace mote::core {
namespace {

using Columns = std::vector<std::size_t>;

std::optional<std::size_t> find(std::span<const PlyColumn> columns, const std::string& name) {
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i].free && columns[i].name == name) return i;
    return std::nullopt;
}

std::optional<PlyAttribute> colour(std::span<const PlyColumn> columns, const std::string& stem,
                                   const std::array<const char*, 3>& channels, const std::string& name) {
    PlyAttribute attribute{name, {}, 1.0};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto column = find(columns, stem + channels[i]);
        if (!column) return std::nullopt;
        attribute.columns[i] = *column;
    }
    if (const double largest = columns[attribute.columns[0]].largest; largest > 0.0)
        attribute.factor = 1.0 / largest;
    return attribute;
}

}  // namespace

std::vector<PlyAttribute> find_ply_attributes(std::span<const PlyColumn> columns, const std::string& prefix) {
    constexpr std::array<const char*, 3> letters = {"r", "g", "b"}, words = {"red", "green", "blue"};
    std::vector<PlyAttribute> found;
    auto plain = colour(columns, "", letters, prefix + "color");
    if (!plain) plain = colour(columns, "", words, prefix + "color");
    if (plain) found.push_back(*plain);

    std::map<std::string, Columns> groups;  // by stem
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::size_t underscore = columns[i].name.rfind('_');
        if (columns[i].free && underscore != std::string::npos && underscore > 0)
            groups[columns[i].name.substr(0, underscore)].push_back(i);
    }
    for (const auto& [stem, group] : groups) {
        if (const auto c = colour(columns, stem + "_", letters, prefix + stem + "_color"))
            found.push_back(*c);
        else if (group.size() == 3)
            found.push_back({prefix + stem, {group[0], group[1], group[2]}, 1.0});
        else if (group.size() == 1)
            found.push_back({prefix + stem, {group[0], group[0], group[0]}, 1.0});
    }
    return found;
}

}  // namespace mote::core
