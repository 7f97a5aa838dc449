// Numbers are read by std::from_chars, which has no locale.
#include "core/objects/number_text.h"

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace mote::core {
namespace {

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

}  // namespace

double parse_number(const std::string& text, const SourceLocation& where) {
    return read_float(trimmed(text), where);
}

std::vector<std::string> split_words(std::string_view text) {
    constexpr const char* separators = " ,\t\n\r";
    std::vector<std::string> words;
    for (std::size_t end = 0, begin; (begin = text.find_first_not_of(separators, end)) != text.npos;) {
        end = std::min(text.find_first_of(separators, begin), text.size());
        words.emplace_back(text.substr(begin, end - begin));
    }
    return words;
}

std::vector<double> parse_numbers(const std::string& text, const SourceLocation& where) {
    std::vector<double> numbers;
    for (const std::string& word : split_words(text)) numbers.push_back(read_float(word, where));
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

std::int64_t parse_integer_text(const std::string& text, const SourceLocation& where) {
    std::int64_t value = 0;
    if (!read_number(trimmed(text), value))
        throw InputError("'" + printable(text, 40) + "' is not an integer", where);
    return value;
}

}  // namespace mote::core
