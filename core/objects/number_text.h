// Numbers from text and back: the same on every machine, whatever its locale.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "core/objects/error.h"

namespace mote::core {

/// One number that a float can hold. Throws InputError for anything else, NaN and infinity included.
double parse_number(const std::string& text, const SourceLocation& where);
/// Words between spaces, line ends and commas.
std::vector<std::string> split_words(std::string_view text);
/// Numbers split by spaces or commas.
std::vector<double> parse_numbers(const std::string& text, const SourceLocation& where);
/// Exactly three numbers.
Vec3d parse_vector(const std::string& text, const SourceLocation& where);
/// "%.17g": the shortest form that reads back as the same number is not needed here, the same number is.
std::string number_to_text(double value);
/// One whole number of 64 bits. Throws InputError for anything else.
std::int64_t parse_integer_text(const std::string& text, const SourceLocation& where);

}  // namespace mote::core
