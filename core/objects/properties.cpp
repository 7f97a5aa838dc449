// Typed access to the values of one element of a scene file.
#include "core/objects/properties.h"

#include <algorithm>
#include <filesystem>

#include "core/objects/registry.h"

namespace mote::core {
namespace {

/// Kind of a value, in the words of the scene language.
std::string kind_name(const PropertyValue& value) {
    static const char* const names[] = {"boolean", "integer", "float",    "string",
                                        "rgb",     "vector",  "transform"};
    return names[value.index()];
}

[[noreturn]] void wrong_kind(const std::string& name, const Properties::Value& v, const char* wanted) {
    throw InputError("'" + name + "' must be " + wanted + ", not a " + kind_name(v.value), v.where);
}

std::string number_text(double v) {
    std::string text = std::to_string(v);
    text.erase(text.find_last_not_of('0') + 1);
    if (!text.empty() && text.back() == '.') text.pop_back();
    return text;
}

std::string range_text(double lower, double upper) {
    const bool no_lower = lower <= std::numeric_limits<float>::lowest();
    const bool no_upper = upper >= std::numeric_limits<float>::max();
    if (no_upper) return "must be at least " + number_text(lower);
    if (no_lower) return "must be at most " + number_text(upper);
    return "must lie between " + number_text(lower) + " and " + number_text(upper);
}

double number(const std::string& name, const Properties::Value& v) {
    double result = 0.0;
    if (const auto* f = std::get_if<double>(&v.value))
        result = *f;
    else if (const auto* i = std::get_if<std::int64_t>(&v.value))
        result = double(*i);
    else
        wrong_kind(name, v, "a float");
    if (!std::isfinite(result)) throw InputError("'" + name + "' is not a finite number", v.where);
    return result;
}

const Properties::Value* find(const Properties& p, const std::string& name) {
    const auto it = p.values.find(name);
    return it == p.values.end() ? nullptr : &it->second;
}

const Properties::Value& require(const Properties& p, const std::string& name) {
    if (const auto* v = find(p, name)) return *v;
    throw InputError(category_name(p.category) + " '" + p.type + "' needs the parameter '" + name + "'",
                     p.where);
}

}  // namespace

bool Properties::has(const std::string& name) const {
    return values.count(name) > 0 ||
           std::any_of(children.begin(), children.end(), [&](const Child& c) { return c.name == name; });
}

bool Properties::get_bool(const std::string& name, bool default_value) const {
    const Value* v = find(*this, name);
    if (!v) return default_value;
    const auto* b = std::get_if<bool>(&v->value);
    if (!b) wrong_kind(name, *v, "a boolean");
    return *b;
}

std::int64_t Properties::get_int(const std::string& name, std::int64_t default_value) const {
    const Value* v = find(*this, name);
    if (!v) return default_value;
    const auto* i = std::get_if<std::int64_t>(&v->value);
    if (!i) wrong_kind(name, *v, "an integer");
    return *i;
}

double Properties::get_float(const std::string& name, double default_value) const {
    const Value* v = find(*this, name);
    return v ? number(name, *v) : default_value;
}

double Properties::require_float(const std::string& name) const { return number(name, require(*this, name)); }

std::string Properties::get_string(const std::string& name, const std::string& default_value) const {
    return find(*this, name) ? require_string(name) : default_value;
}

std::string Properties::require_string(const std::string& name) const {
    const Value& v = require(*this, name);
    const auto* s = std::get_if<std::string>(&v.value);
    if (!s) wrong_kind(name, v, "a string");
    return *s;
}

std::string Properties::get_choice(const std::string& name, const std::string& default_value,
                                   const std::vector<std::string>& choices) const {
    const std::string word = get_string(name, default_value);
    if (std::find(choices.begin(), choices.end(), word) == choices.end())
        throw InputError("'" + name + "' cannot be '" + printable(word) + "'" + suggestion(word, choices),
                         where_of(name));
    return word;
}

double Properties::get_float_in(const std::string& name, double default_value, double lower,
                                double upper) const {
    const double value = get_float(name, default_value);
    if (!(value >= lower && value <= upper))
        throw InputError("'" + name + "' is " + number_text(value) + " but " + range_text(lower, upper),
                         where_of(name));
    return value;
}

std::int64_t Properties::get_int_in(const std::string& name, std::int64_t default_value, std::int64_t lower,
                                    std::int64_t upper) const {
    const std::int64_t value = get_int(name, default_value);
    if (value < lower || value > upper)
        throw InputError(
            name + " must lie between " + std::to_string(lower) + " and " + std::to_string(upper),
            where_of(name));
    return value;
}

std::string Properties::find_file(const std::string& name) const {
    namespace fs = std::filesystem;
    const std::string file = require_string(name);
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

std::string Properties::kind_of(Category c) { return category_name(c); }

}  // namespace mote::core
