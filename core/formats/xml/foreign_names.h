// Names that files written for Mitsuba may hold although it means nothing here.
#pragma once

#include <string>
#include <vector>

#include "core/formats/xml/scene_element.h"
#include "core/objects/registry.h"

namespace mote::core {

/// Removes the parameters of one element that Mitsuba (or another renderer of its language) has but that
/// change nothing here, and says so in one warning. One whose value would change the picture becomes a fault.
void drop_foreign_parameters(Element& element, const Manual& manual, std::vector<std::string>& warnings);

/// Removes elements that other renderers added to the language and that change nothing here, with a warning.
void drop_foreign_elements(Element& scene, std::vector<std::string>& warnings);

/// Gives samplers and films of Mitsuba that have a near equal here the name of the equal, with a warning.
void replace_foreign_types(Element& scene, const Registry& registry, std::vector<std::string>& warnings);

/// The type that such a one is replaced by, or "".
std::string replacement_of(Category category, const std::string& type);

/// Brings elements of files of version < 2 to today's names and meanings: camelCase to snake_case, sigma_s
/// and sigma_a to sigma_t and albedo, and so on.
void upgrade_legacy(Element& scene, std::vector<std::string>& warnings);

}  // namespace mote::core
