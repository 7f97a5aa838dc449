// From the text of value elements to numbers, colours, vectors and transforms.
#pragma once

#include <string>
#include <vector>

#include "core/formats/xml/scene_element.h"
#include "core/objects/number_text.h"
#include "core/objects/properties.h"

namespace mote::core {

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
