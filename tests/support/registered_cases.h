// Nothing registered goes untested: every type of a category needs a case in the statistical tests.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <typeinfo>
#include <vector>

#include "core/objects/properties.h"
#include "core/objects/registry.h"

namespace mote::tests {

/// For every registered type of the category that is not among `tested`: "no chi² case for bsdf 'type'". And
/// for every tested one that is not registered: a case whose name was misspelt would cover nothing.
std::vector<std::string> untested_types(const core::Registry& registry, core::Category category,
                                        const std::set<std::string>& tested);

/// An object of a registered type, with these values and the defaults of its manual page for the rest. Throws
/// std::bad_cast when it is no T.
template <typename T>
std::shared_ptr<T> make_registered(const core::Registry& registry, core::Category category,
                                   const std::string& type,
                                   const std::map<std::string, core::PropertyValue>& values = {}) {
    core::Properties properties;
    properties.category = category, properties.type = type, properties.where = {"test", 1};
    for (const auto& [name, value] : values) properties.values[name] = {value, {"test", 1}};
    auto object = std::dynamic_pointer_cast<T>(registry.factory(category, type)(properties));
    if (!object) throw std::bad_cast();
    return object;
}

}  // namespace mote::tests
