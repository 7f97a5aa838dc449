// One row of a manual page, with everything that is said about a parameter: the page, Python's help and the
// tests take their values from it.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace mote::core {

/// The numbers that a parameter takes, and their unit. Made by the functions below.
struct Range {
    double lower = -std::numeric_limits<double>::infinity();  ///< smallest number, or infinite
    double upper = std::numeric_limits<double>::infinity();   ///< largest number, or infinite
    bool above = false;                                       ///< the lower end is excluded
    bool below = false;                                       ///< the upper end is excluded
    std::string unit{};            ///< "m", "1/m", "degrees", ...; "" for pure numbers
    std::optional<double> word{};  ///< a number outside that is allowed, too,
    std::string meaning{};         ///< and its meaning

    /// Adds an upper end: `above(0).up_to(1)`.
    Range up_to(double its_upper) const;
    /// Adds one number outside of the range: `at_least(1).or_else(-1, "no limit")`.
    Range or_else(double number, std::string its_meaning) const;
    /// False for every number outside, and for NaN.
    bool contains(double number) const;
    /// "0 to 1", "above 0 to 1", "1 or more; -1: no limit"; "" where every number will do.
    std::string text() const;
    /// "must lie between 0 and 1", "must be above 0 m", ...: the end of an error's sentence.
    std::string demand() const;
};

/// Both ends included.
Range between(double lower, double upper, std::string unit = "");
/// Both ends excluded.
Range inside(double lower, double upper, std::string unit = "");
Range at_least(double lower, std::string unit = "");
Range above(double lower, std::string unit = "");
/// Every number of this unit.
Range any(std::string unit);

/// A number as pages and messages show it: the shortest text, and 2^n for large powers of two.
std::string short_number(double value);

/// One row of a manual page. `type` is one of: boolean, integer, float, string, rgb, point, vector,
/// transform, texture (an rgb, a float or a nested texture), volume, or the name of a category for a nested
/// object.
struct Parameter {
    std::string name, type, default_value, description;  ///< as the page shows them
    Range range{};                                       ///< of numbers, colours and textures
    std::vector<std::string> choices{};                  ///< of a string; empty: any text
    bool required = false;                               ///< has no default
};

/// "0 to 1 [m]", "exact, steps": what may be given, as a page shows it. "" where every value of the type may.
std::string values_text(const Parameter& parameter);

}  // namespace mote::core
