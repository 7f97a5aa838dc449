// Content of an element, so that two that are written alike can be one object.
#pragma once

#include <string>

#include "core/formats/xml/element_checks.h"

namespace mote::core {

/// Type and everything inside, but neither the id nor the name under which it is used. Equal where two
/// elements are written alike and refer to the same objects; children in another order make it another
/// content.
std::string content_of(const Element& element, const IdTable& ids);

}  // namespace mote::core
