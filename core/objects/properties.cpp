#include "core/objects/properties.h"

#include <algorithm>
#include <filesystem>

namespace mote::core {
namespace {

const Properties::Value* find(const Properties& p, const std::string& name) {
    const auto it = p.values.find(name);
    return it == p.values.end() ? nullptr : &it->second;
}

}  // namespace

bool Properties::has(const std::string& name) const {
    return values.count(name) > 0 ||
           std::any_of(children.begin(), children.end(), [&](const Child& c) { return c.name == name; });
}

std::string Properties::find_file(const std::string& name) const {
    namespace fs = std::filesystem;
    const Value* value = find(*this, name);
    if (!value || !std::holds_alternative<std::string>(value->value))
        throw InputError("'" + name + "' must be the name of a file", where_of(name));
    const std::string& file = std::get<std::string>(value->value);
    std::error_code ignored;  // a path that cannot be read is not there
    std::vector<fs::path> candidates;
    const bool absolute = fs::path(file).is_absolute() || search_paths.empty();
    if (absolute) candidates.emplace_back(file);
    for (const std::string& folder : search_paths)
        if (!absolute) candidates.push_back(fs::path(folder) / file);
    for (const fs::path& path : candidates) {
        if (!fs::exists(path, ignored)) continue;
        if (!fs::is_regular_file(path, ignored))
            throw InputError("'" + printable(file) + "' is not a file", where_of(name));
        if (files) files->push_back(path.string());
        return path.string();
    }
    throw InputError("file '" + printable(file, 300) + "' was not found", where_of(name));
}

SourceLocation Properties::where_of(const std::string& name) const {
    if (const Value* v = find(*this, name)) return v->where;
    for (const Child& c : children)
        if (c.name == name) return c.where;
    return where;
}

void Properties::warn(const std::string& message) const {
    if (warnings) warnings->push_back(InputError(message, where).what());
}

}  // namespace mote::core
