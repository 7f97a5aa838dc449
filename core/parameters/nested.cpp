#include "core/parameters/nested.h"

namespace mote::core {

std::vector<Properties::Child> nested_children(const Properties& properties, const Row& row, bool single) {
    std::vector<Properties::Child> found;
    for (const Properties::Child& child : properties.children)
        if (category_name(child.category) == row.parameter.type &&
            (!single || child.name == row.parameter.name || child.name.empty()))
            found.push_back(child);
    if (single && found.size() > 1)
        throw InputError("more than one nested " + row.parameter.type, found[1].where);
    return found;
}

void wrong_object(const Properties::Child& child) {
    throw InputError("'" + child.name + "' is an object of the wrong kind", child.where);
}

}  // namespace mote::core
