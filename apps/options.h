// Options that several commands have, and numbers on the command line: CLI11 takes "nan" for positive and
// lets whole numbers wrap around.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/formats/meshes/text_scanner.h"
#include "core/objects/error.h"

namespace mote::apps {

/// A finite number for which `holds`; `wanted` completes "expected ...".
template <typename Predicate>
CLI::Validator finite_number(const std::string& wanted, Predicate holds) {
    return CLI::Validator(
        [wanted, holds](std::string& text) {
            const auto value = core::TextScanner::parse_number(text);
            if (value && std::isfinite(*value) && holds(*value)) return std::string();
            return "'" + core::printable(text, 40) + "': expected " + wanted;
        },
        "");
}

inline CLI::Validator number_above_0() {
    return finite_number("a number above 0", [](double v) { return v > 0.0; });
}
inline CLI::Validator number_from_0() {
    return finite_number("a number of 0 or more", [](double v) { return v >= 0.0; });
}
inline CLI::Validator number_between(double lower, double upper) {
    return finite_number(
        "a number from " + CLI::detail::to_string(lower) + " to " + CLI::detail::to_string(upper),
        [lower, upper](double v) { return v >= lower && v <= upper; });
}

/// A whole number in decimal digits.
inline CLI::Validator whole_number(std::uint64_t lower, std::uint64_t upper) {
    return CLI::Validator(
        [lower, upper](std::string& text) {
            std::uint64_t value = 0;
            const char* last = text.data() + text.size();
            const auto [end, error] = std::from_chars(text.data(), last, value);
            if (error == std::errc() && end == last && value >= lower && value <= upper) return std::string();
            return "'" + core::printable(text, 40) + "': expected a whole number from " +
                   std::to_string(lower) + " to " + std::to_string(upper);
        },
        "");
}

inline void add_threads(CLI::App& command, int& threads) {
    command.add_option("-t,--threads", threads, "Number of threads (default: one for every core)")
        ->check(whole_number(0, 4096));
}
inline void add_exposure(CLI::App& command, std::optional<float>& exposure) {
    command
        .add_option("--exposure", exposure, "Brighten the preview by this many stops (default: it adapts)")
        ->check(number_between(-100.0, 100.0));
}
inline void add_half(CLI::App& command, bool& half) {
    command.add_flag("--half", half, "Write float16 instead of float32");
}
/// An option that may be given several times, with one value each.
inline CLI::Option* add_repeatable(CLI::App& command, const std::string& name,
                                   std::vector<std::string>& values, const std::string& description) {
    return command.add_option(name, values, description)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace mote::apps
