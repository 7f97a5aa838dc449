// Numbers are read by std::from_chars: the same on every machine, whatever its locale.
#include "core/scene/scene_values.h"

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <cstdio>

#include "core/scene/spectrum.h"

namespace mote::core {
namespace {

constexpr const char* separators = " ,\t\n\r";

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\n\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\n\r") - first + 1);
}

template <typename Number>
bool read_number(std::string_view text, Number& value) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

double read_float(std::string_view text, const SourceLocation& where) {
    double value = 0.0;
    if (!read_number(text, value)) throw InputError("'" + printable(text, 40) + "' is not a number", where);
    if (!std::isfinite(value) || std::fabs(value) > double(FLT_MAX))
        throw InputError("'" + printable(text, 40) + "' is not a finite number", where);
    return value;
}

bool parse_boolean(const Element& e) {
    const std::string& text = e.require("value");
    if (text == "true" || text == "True") return true;
    if (text == "false" || text == "False") return false;
    throw InputError("'" + printable(text, 40) + "' is neither true nor false", e.where);
}

std::int64_t parse_integer(const Element& e) {
    std::int64_t value = 0;
    if (!read_number(trimmed(e.require("value")), value))
        throw InputError("'" + printable(e.require("value"), 40) + "' is not an integer", e.where);
    return value;
}

Rgb parse_rgb(const Element& e) {
    const std::vector<double> v = parse_numbers(e.require("value"), e.where);
    if (v.size() == 1) return Rgb(float(v[0]));
    if (v.size() == 3) return {float(v[0]), float(v[1]), float(v[2])};
    throw InputError("an rgb has one or three numbers, not " + std::to_string(v.size()), e.where);
}

Vec3d parse_point(const Element& e) {
    if (const std::string* value = e.find("value")) {
        if (e.find("x") || e.find("y") || e.find("z"))
            throw InputError("give either 'value' or x, y and z", e.where);
        return parse_vector(*value, e.where);
    }
    return {parse_number(e.require("x"), e.where), parse_number(e.require("y"), e.where),
            parse_number(e.require("z"), e.where)};
}

}  // namespace

double parse_number(const std::string& text, const SourceLocation& where) {
    return read_float(trimmed(text), where);
}

std::vector<double> parse_numbers(const std::string& text, const SourceLocation& where) {
    std::vector<double> numbers;
    const std::string_view view = text;
    for (std::size_t i = view.find_first_not_of(separators); i != std::string_view::npos;) {
        const std::size_t end = std::min(view.find_first_of(separators, i), view.size());
        numbers.push_back(read_float(view.substr(i, end - i), where));
        i = view.find_first_not_of(separators, end);
    }
    return numbers;
}

Vec3d parse_vector(const std::string& text, const SourceLocation& where) {
    const std::vector<double> v = parse_numbers(text, where);
    if (v.size() != 3)
        throw InputError("three numbers are needed here, not " + std::to_string(v.size()), where);
    return {v[0], v[1], v[2]};
}

std::string number_to_text(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

const std::vector<std::string>& value_tags() {
    static const std::vector<std::string> tags = {"boolean",  "integer", "float",  "string",   "rgb",
                                                  "spectrum", "point",   "vector", "transform"};
    return tags;
}

bool is_value_tag(const std::string& tag) {
    return std::find(value_tags().begin(), value_tags().end(), tag) != value_tags().end();
}

PropertyValue parse_value(const Element& e, bool emission, std::vector<std::string>& warnings) {
    if (e.tag == "transform") return parse_transform(e);
    if (!e.children.empty())
        throw InputError("<" + e.tag + "> holds no other elements", e.children.front().where);
    if (e.tag == "point" || e.tag == "vector") {
        e.check_attributes({"name", "value", "x", "y", "z"});
        return parse_point(e);
    }
    if (e.tag == "spectrum" && e.find("filename"))
        throw InputError("spectra in files are not supported; write the table as value=\"400:0.1, 500:...\"",
                         e.where);
    e.check_attributes({"name", "value"});
    if (e.tag == "boolean") return parse_boolean(e);
    if (e.tag == "integer") return parse_integer(e);
    if (e.tag == "float") return parse_number(e.require("value"), e.where);
    if (e.tag == "string") return e.require("value");
    if (e.tag == "rgb") return parse_rgb(e);
    return parse_spectrum(e.require("value"), emission, e.where, warnings);
}

}  // namespace mote::core
