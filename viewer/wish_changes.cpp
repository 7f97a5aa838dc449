#include "viewer/wish_changes.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/objects/error.h"

namespace mote::viewer {

using core::InputError;

namespace {

constexpr std::size_t max_define = 400, max_defines = 200;

}  // namespace

bool is_of_integrator(const std::string& path) { return path.starts_with("integrator."); }

session::SceneChanges outside_integrator(session::SceneChanges changes) {
    set_integrator(changes, "");
    return changes;
}

void set_integrator(session::SceneChanges& changes, const std::string& type) {
    changes.integrator = type;
    std::erase_if(changes.defines, [](const auto& d) { return is_of_integrator(d.first); });
}

void set_define(session::SceneChanges& changes, const std::string& path, const nlohmann::json& value) {
    if (path.size() > max_define || path.find('.') == std::string::npos)
        throw InputError("'" + core::printable(path, 60) + "' is no path of a parameter");
    std::erase_if(changes.defines,
                  [&](const auto& d) { return d.first == path || d.first.starts_with(path + "."); });
    if (value.is_null()) return;
    if (!value.is_string() || value.get_ref<const std::string&>().size() > max_define)
        throw InputError("the value of '" + path + "' is no text of " + std::to_string(max_define) +
                         " characters at most");
    if (changes.defines.size() >= max_defines) throw InputError("there are too many changes");
    changes.defines.emplace_back(path, value.get<std::string>());
}

}  // namespace mote::viewer
