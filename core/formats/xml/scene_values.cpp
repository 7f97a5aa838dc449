// Value elements of the scene language.
#include "core/formats/xml/scene_values.h"

#include <algorithm>
#include <charconv>

#include "core/formats/xml/spectrum.h"
#include "core/math/srgb.h"

namespace mote::core {
namespace {

bool parse_boolean(const Element& e) {
    const std::string& text = e.require("value");
    if (text == "true" || text == "True") return true;
    if (text == "false" || text == "False") return false;
    throw InputError("'" + printable(text, 40) + "' is neither true nor false", e.where);
}

std::int64_t parse_integer(const Element& e) { return parse_integer_text(e.require("value"), e.where); }

/// "#b03020" as on the web: six hexadecimal digits of sRGB. Mitsuba 0.x read it so; 3.9.1 refuses it.
Rgb parse_hexadecimal(const std::string& text, const SourceLocation& where) {
    unsigned bits = 0;
    const char* const end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data() + 1, end, bits, 16);
    if (text.size() != 7 || error != std::errc() || last != end)
        throw InputError("'" + printable(text, 40) + "' is no colour such as #b03020", where);
    const auto channel = [&](unsigned shift) { return decode_srgb(float((bits >> shift) & 255u) / 255.0f); };
    return {channel(16), channel(8), channel(0)};
}

Rgb parse_rgb(const Element& e) {
    if (const std::string& text = e.require("value"); text.starts_with('#'))
        return parse_hexadecimal(text, e.where);
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
