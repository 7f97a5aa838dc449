// Reading and checked access.
#include "core/formats/pbrt/pbrt_parameters.h"

#include <algorithm>
#include <cmath>

namespace mote::core {
namespace {

const std::vector<std::string>& types() {
    static const std::vector<std::string> list = {
        "integer", "float",  "bool",   "string", "point2", "vector2",  "point3",    "vector3", "normal3",
        "point",   "vector", "normal", "rgb",    "color",  "spectrum", "blackbody", "texture"};
    return list;
}

void add_value(PbrtParameter& p, const PbrtToken& token, const SourceLocation& where) {
    if (p.type == "bool") {
        if (token.text != "true" && token.text != "false")
            throw InputError("'" + printable(token.text, 40) + "' is neither true nor false", where);
        return p.numbers.push_back(token.text == "true" ? 1.0 : 0.0);
    }
    const bool takes_text = p.type == "string" || p.type == "texture" || p.type == "spectrum";
    if (token.quoted != takes_text && !(p.type == "spectrum" && !token.quoted))
        throw InputError("'" + printable(p.name, 40) + "' of type " + p.type + " holds '" +
                             printable(token.text, 40) + "'",
                         where);
    if (token.quoted)
        p.strings.push_back(token.text);
    else
        p.numbers.push_back(pbrt_number(token.text, where));
}

void read_values(PbrtText& text, PbrtParameter& p) {
    PbrtToken token = text.require("a value");
    if (token.quoted || token.text != "[") return add_value(p, token, text.where(token.line));
    for (;;) {
        token = text.require("a value or ']'");
        if (!token.quoted && token.text == "]") return;
        add_value(p, token, text.where(token.line));
    }
}

PbrtParameter declared(const PbrtToken& token, const SourceLocation& where) {
    const auto first = token.text.find_first_not_of(" \t");
    const auto end = token.text.find_first_of(" \t", first);
    const auto name = token.text.find_first_not_of(" \t", end);
    if (first == std::string::npos || name == std::string::npos)
        throw InputError("'" + printable(token.text, 40) + "' is not of the form \"type name\"", where);
    PbrtParameter p;
    p.type = token.text.substr(first, end - first);
    p.name = token.text.substr(name, token.text.find_first_of(" \t", name) - name);
    p.where = where;
    if (std::find(types().begin(), types().end(), p.type) == types().end())
        throw InputError(
            "'" + printable(p.type, 40) + "' is no type of a parameter" + suggestion(p.type, types()), where);
    return p;
}

const PbrtParameter& checked(const PbrtParameter& p, std::size_t numbers, std::size_t strings) {
    if (p.numbers.size() == numbers && p.strings.size() == strings) return p;
    throw InputError(
        "'" + printable(p.name, 40) + "' needs " +
            (strings ? "one string" : std::to_string(numbers) + " number" + (numbers > 1 ? "s" : "")),
        p.where);
}

}  // namespace

std::vector<PbrtParameter> read_pbrt_parameters(PbrtText& text, const std::string& color_space) {
    std::vector<PbrtParameter> list;
    while (auto token = text.next()) {
        if (!token->quoted) {
            text.put_back(*std::move(token));
            break;
        }
        list.push_back(declared(*token, text.where(token->line)));
        list.back().color_space = color_space;
        read_values(text, list.back());
    }
    return list;
}

const PbrtParameter* PbrtObject::find(const std::string& name) const {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.push_back(name);
    const auto it =
        std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
    if (it == parameters.end()) return nullptr;
    it->used = true;
    return &*it;
}

double PbrtObject::number(const std::string& name, double default_value) const {
    const PbrtParameter* p = find(name);
    return p ? checked(*p, 1, 0).numbers[0] : default_value;
}

int PbrtObject::integer(const std::string& name, int default_value) const {
    const double value = number(name, default_value);
    if (value != std::floor(value) || std::fabs(value) > 2147483647.0)
        throw InputError("'" + name + "' is no whole number", find(name)->where);
    return int(value);
}

bool PbrtObject::flag(const std::string& name, bool default_value) const {
    return number(name, default_value ? 1.0 : 0.0) != 0.0;
}

std::string PbrtObject::text(const std::string& name, const std::string& default_value) const {
    const PbrtParameter* p = find(name);
    return p ? checked(*p, 0, 1).strings[0] : default_value;
}

Vec3d PbrtObject::point(const std::string& name, const Vec3d& default_value) const {
    const PbrtParameter* p = find(name);
    if (!p) return default_value;
    const auto& n = checked(*p, 3, 0).numbers;
    return {n[0], n[1], n[2]};
}

std::vector<double> PbrtObject::numbers(const std::string& name) const {
    const PbrtParameter* p = find(name);
    return p ? p->numbers : std::vector<double>{};
}

void PbrtObject::ignore(std::initializer_list<const char*> names) const {
    for (const char* name : names) find(name);
}

std::vector<InputError> PbrtObject::unknown() const {
    std::vector<InputError> errors;
    for (const PbrtParameter& p : parameters)
        if (!p.used && !p.of_attribute)
            errors.emplace_back("'" + printable(type, 40) + "' has no parameter '" + printable(p.name, 40) +
                                    "'" + suggestion(p.name, known_),
                                p.where);
    return errors;
}

}  // namespace mote::core
