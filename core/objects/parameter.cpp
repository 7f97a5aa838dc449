#include "core/objects/parameter.h"

#include <cmath>

#include <fmt/format.h>

namespace mote::core {

Range Range::or_else(double number, std::string its_meaning) const {
    Range result = *this;
    result.word = number, result.meaning = std::move(its_meaning);
    return result;
}

bool Range::contains(double number) const {
    if (word && number == *word) return true;
    if (number == lower || number == upper) return !open && std::isfinite(number);
    return number > lower && number < upper;
}

std::string Range::text() const {
    std::string result;
    if (std::isfinite(lower) && std::isfinite(upper))
        result = short_number(lower) + " to " + short_number(upper) + (open ? ", both excluded" : "");
    else if (std::isfinite(lower))
        result = open ? "above " + short_number(lower) : short_number(lower) + " or more";
    else if (std::isfinite(upper))
        result = open ? "below " + short_number(upper) : short_number(upper) + " or less";
    return word ? result + "; " + short_number(*word) + ": " + meaning : result;
}

std::string Range::demand() const {
    const std::string of_unit = unit.empty() ? "" : " " + unit;
    std::string result;
    if (std::isfinite(lower) && std::isfinite(upper))
        result = "must lie between " + short_number(lower) + " and " + short_number(upper) + of_unit +
                 (open ? ", both excluded" : "");
    else if (std::isfinite(lower))
        result = (open ? "must be above " : "must be at least ") + short_number(lower) + of_unit;
    else
        result = (open ? "must be below " : "must be at most ") + short_number(upper) + of_unit;
    return word ? result + ", or " + short_number(*word) + " (" + meaning + ")" : result;
}

Range between(double lower, double upper, std::string unit) {
    return {.lower = lower, .upper = upper, .unit = std::move(unit)};
}
Range inside(double lower, double upper, std::string unit) {
    return {.lower = lower, .upper = upper, .open = true, .unit = std::move(unit)};
}
Range at_least(double lower, std::string unit) { return {.lower = lower, .unit = std::move(unit)}; }
Range above(double lower, std::string unit) {
    return {.lower = lower, .open = true, .unit = std::move(unit)};
}
Range any(std::string unit) { return {.unit = std::move(unit)}; }

std::string short_number(double value) {
    int exponent = 0;
    if (value >= 1 << 17 && std::frexp(value, &exponent) == 0.5) return fmt::format("2^{}", exponent - 1);
    return fmt::format("{}", value);
}

std::string values_text(const Parameter& parameter) {
    std::string text = parameter.range.text();
    for (const std::string& word : parameter.choices) text += (text.empty() ? "" : ", ") + word;
    if (parameter.range.unit.empty()) return text;
    return text + (text.empty() ? "[" : " [") + parameter.range.unit + "]";
}

}  // namespace mote::core
