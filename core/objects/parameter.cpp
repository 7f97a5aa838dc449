#include "core/objects/parameter.h"

#include <cmath>

#include <fmt/format.h>

namespace mote::core {

Range Range::up_to(double its_upper) const {
    Range result = *this;
    result.upper = its_upper;
    return result;
}

Range Range::or_else(double number, std::string its_meaning) const {
    Range result = *this;
    result.word = number, result.meaning = std::move(its_meaning);
    return result;
}

bool Range::contains(double number) const {
    if (word && number == *word) return true;
    return (above ? number > lower : number >= lower) && (below ? number < upper : number <= upper);
}

std::string Range::text() const {
    std::string result;
    if (std::isfinite(lower) && std::isfinite(upper))
        result = (above ? "above " : "") + short_number(lower) + (below ? " to below " : " to ") +
                 short_number(upper);
    else if (std::isfinite(lower))
        result = above ? "above " + short_number(lower) : short_number(lower) + " or more";
    else if (std::isfinite(upper))
        result = below ? "below " + short_number(upper) : short_number(upper) + " or less";
    return word ? result + "; " + short_number(*word) + ": " + meaning : result;
}

std::string Range::demand() const {
    const std::string of_unit = unit.empty() ? "" : " " + unit;
    const std::string from = (above ? "be above " : "be at least ") + short_number(lower),
                      to = (below ? "below " : "at most ") + short_number(upper);
    std::string result;
    if (!std::isfinite(upper))
        result = from + of_unit;
    else if (!std::isfinite(lower))
        result = "be " + to + of_unit;
    else if (above == below)
        result = "lie between " + short_number(lower) + " and " + short_number(upper) + of_unit +
                 (above ? ", both excluded" : "");
    else
        result = from + " and " + to + of_unit;
    return "must " + result + (word ? ", or " + short_number(*word) + " (" + meaning + ")" : "");
}

Range between(double lower, double upper, std::string unit) {
    return {.lower = lower, .upper = upper, .unit = std::move(unit)};
}
Range inside(double lower, double upper, std::string unit) {
    return {.lower = lower, .upper = upper, .above = true, .below = true, .unit = std::move(unit)};
}
Range at_least(double lower, std::string unit) { return {.lower = lower, .unit = std::move(unit)}; }
Range above(double lower, std::string unit) {
    return {.lower = lower, .above = true, .unit = std::move(unit)};
}
Range any(std::string unit) { return {.unit = std::move(unit)}; }

std::string short_number(double value) {
    int exponent = 0;
    if (value >= 1 << 17 && std::frexp(value, &exponent) == 0.5) return fmt::format("2^{}", exponent - 1);
    if (value == std::floor(value) && std::fabs(value) < 1e15) return fmt::format("{:.0f}", value);
    const std::string exact = fmt::format("{}", value);
    return exact.size() > 9 ? fmt::format("{:.6g}", value) : exact;
}

std::string values_text(const Parameter& parameter) {
    std::string text = parameter.range.text();
    for (const std::string& word : parameter.choices) text += (text.empty() ? "" : ", ") + word;
    if (parameter.range.unit.empty()) return text;
    return text + (text.empty() ? "[" : " [") + parameter.range.unit + "]";
}

}  // namespace mote::core
