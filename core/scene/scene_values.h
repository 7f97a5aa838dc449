// From the text of value elements to numbers, colours, vectors and transforms.
#pragma once

#include <string>
#include <vector>

#include "core/scene/properties.h"
#include "core/scene/scene_element.h"

namespace mote::core {

/// One number that a float can hold. Throws InputError for anything else, NaN and infinity included.
double parse_number(const std::string& text, const SourceLocation& where);
/// Numbers split by spaces or commas.
std::vector<double> parse_numbers(const std::string& text, const SourceLocation& where);
/// Exactly three numbers.
Vec3d parse_vector(const std::string& text, const SourceLocation& where);
/// "%.17g": the shortest form that reads back as the same number is not needed here, the same number is.
std::string number_to_text(double value);

/// True for the tags that hold a value: boolean, integer, float, string, rgb, spectrum, point, vector,
/// transform.
bool is_value_tag(const std::string& tag);
/// The names of those tags.
const std::vector<std::string>& value_tags();

/// The value of such an element. `emission`: a <spectrum> is light, not a reflectance (see spectrum.h);
/// what was approximated is added to `warnings`.
PropertyValue parse_value(const Element& element, bool emission, std::vector<std::string>& warnings);

/// <transform>: its children multiply from the left in order. Throws InputError when the product is singular.
Transform parse_transform(const Element& element);

}  // namespace mote::core
