#include "core/film/transport.h"

#include <array>

#include "core/objects/number_text.h"

namespace mote::core {

namespace {

struct NamedCells {
    const char* name;
    TransportSet cells;
};
/// A whole before its elements.
constexpr std::array<NamedCells, 7> named_cells{
    {{"emission", Transport::emission},
     {"direct", Transport::direct},
     {"indirect", Transport::indirect},
     {"single_scattering", Transport::single_scattering},
     {"single_scattering_positional", TransportSet::positional_scattering()},
     {"single_scattering_other", TransportSet::other_scattering()},
     {"multiple_scattering", Transport::multiple_scattering}}};

TransportSet cells_named(const std::string& name, const SourceLocation& where) {
    std::vector<std::string> all;
    for (const NamedCells& known : named_cells) {
        if (name == known.name) return known.cells;
        all.emplace_back(known.name);
    }
    throw InputError("'" + printable(name) + "' is no cell of the transport" + suggestion(name, all), where);
}

}  // namespace

std::vector<std::string> transport_names(TransportSet cells) {
    std::vector<std::string> names;
    for (const NamedCells& known : named_cells)
        if (cells.contains(known.cells)) names.emplace_back(known.name), cells = cells - known.cells;
    return names;
}

std::string transport_name(TransportSet cells) {
    std::string text;
    for (const std::string& name : transport_names(cells)) text += (text.empty() ? "" : ", ") + name;
    return text;
}

TransportSet read_transport(const std::string& names, const SourceLocation& where) {
    TransportSet cells;
    for (const std::string& name : split_words(names)) cells = cells | cells_named(name, where);
    return cells;
}

}  // namespace mote::core
