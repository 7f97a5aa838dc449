#include "tests/support/registered_cases.h"

#include <algorithm>

namespace mote::tests {

std::vector<std::string> untested_types(const core::Registry& registry, core::Category category,
                                        const std::set<std::string>& tested) {
    std::vector<std::string> complaints;
    const std::vector<std::string> types = registry.types(category);
    for (const std::string& type : types)
        if (!tested.contains(type))
            complaints.push_back("no chi² case for " + core::category_name(category) + " '" + type + "'");
    for (const std::string& type : tested)
        if (std::find(types.begin(), types.end(), type) == types.end())
            complaints.push_back("a chi² case for " + core::category_name(category) + " '" + type +
                                 "', which is not registered");
    return complaints;
}

}  // namespace mote::tests
